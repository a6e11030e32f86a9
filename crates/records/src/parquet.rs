//! A table as a Parquet file: one row group, Snappy, every column optional. The crate's plain column writers are enough
//! for a flat table; Arrow would double the dependencies.

use crate::table::{Column, RecordTable};
use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as PhysicalType};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};
use std::sync::Arc;

impl RecordTable {
    /// The table as a Parquet file. The same table gives the same bytes.
    pub fn to_parquet(&self) -> Vec<u8> {
        // Into memory, by a schema made from the same columns: there is nothing left to go wrong.
        self.write_parquet().expect("a table of equal columns is written into memory")
    }

    fn write_parquet(&self) -> Result<Vec<u8>, ParquetError> {
        let fields = self.columns.iter().map(|(name, column)| field(name, column)).collect::<Result<_, _>>()?;
        let schema = Arc::new(Type::group_type_builder("records").with_fields(fields).build()?);
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(format!("recrash {}", env!("CARGO_PKG_VERSION")))
            .build();
        let mut writer = SerializedFileWriter::new(Vec::new(), schema, Arc::new(properties))?;
        let mut group = writer.next_row_group()?;
        for (_, column) in &self.columns {
            let mut slot = group.next_column()?.ok_or_else(|| ParquetError::General("too few columns".into()))?;
            write_column(slot.untyped(), column)?;
            slot.close()?;
        }
        group.close()?;
        writer.into_inner()
    }
}

fn field(name: &str, column: &Column) -> Result<TypePtr, ParquetError> {
    let (physical, logical) = match column {
        Column::Text(_) => (PhysicalType::BYTE_ARRAY, Some(LogicalType::String)),
        Column::Whole(_) => (PhysicalType::INT64, None),
        Column::Number(_) => (PhysicalType::DOUBLE, None),
        Column::Flag(_) => (PhysicalType::BOOLEAN, None),
    };
    let converted = if logical.is_some() { ConvertedType::UTF8 } else { ConvertedType::NONE };
    let field = Type::primitive_type_builder(name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical)
        .with_converted_type(converted);
    Ok(Arc::new(field.build()?))
}

/// Definition levels: 1 where there is a value, 0 where there is none; and the values that are there.
fn levels<T, U>(values: &[Option<T>], convert: impl Fn(&T) -> U) -> (Vec<i16>, Vec<U>) {
    (values.iter().map(|value| i16::from(value.is_some())).collect(), values.iter().flatten().map(convert).collect())
}

fn write_column(slot: &mut ColumnWriter<'_>, column: &Column) -> Result<(), ParquetError> {
    match (slot, column) {
        (ColumnWriter::ByteArrayColumnWriter(writer), Column::Text(values)) => {
            let (levels, values) = levels(values, |text| ByteArray::from(text.as_str()));
            writer.write_batch(&values, Some(&levels), None)?;
        }
        (ColumnWriter::Int64ColumnWriter(writer), Column::Whole(values)) => {
            let (levels, values) = levels(values, |number| *number);
            writer.write_batch(&values, Some(&levels), None)?;
        }
        (ColumnWriter::DoubleColumnWriter(writer), Column::Number(values)) => {
            let (levels, values) = levels(values, |number| *number);
            writer.write_batch(&values, Some(&levels), None)?;
        }
        (ColumnWriter::BoolColumnWriter(writer), Column::Flag(values)) => {
            let (levels, values) = levels(values, |flag| *flag);
            writer.write_batch(&values, Some(&levels), None)?;
        }
        _ => return Err(ParquetError::General("the schema is made from the columns".into())),
    }
    Ok(())
}
