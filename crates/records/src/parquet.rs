//! Tables as Parquet files: Snappy, every column optional. The crate's plain column writers are enough for a flat table;
//! Arrow would double the dependencies.

use crate::table::{Column, RecordTable};
use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as PhysicalType};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};
use std::io::Write;
use std::sync::Arc;

impl RecordTable {
    /// The table as a Parquet file. The same table gives the same bytes.
    pub fn to_parquet(&self) -> Vec<u8> {
        // Into memory, by a schema made from the same columns: there is nothing left to go wrong.
        self.write_parquet().expect("a table of equal columns is written into memory")
    }

    fn write_parquet(&self) -> Result<Vec<u8>, ParquetError> {
        let columns = self.columns.iter().map(|(name, column)| (*name, column));
        let mut writer = ParquetWriter::begin(Vec::new(), "records", columns, &[])?;
        writer.put(self.columns.iter().map(|(_, column)| column))?;
        writer.writer.into_inner()
    }
}

/// Writes a table piece by piece: what is in memory is one piece.
pub struct ParquetWriter<W: Write + Send> {
    writer: SerializedFileWriter<W>,
}

impl<W: Write + Send> ParquetWriter<W> {
    /// Begins a table of columns with these names and of these types; `notes` are kept in the file as metadata.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn new<'a>(
        sink: W,
        name: &str,
        columns: impl IntoIterator<Item = (&'a str, &'a Column)>,
        notes: &[(&str, String)],
    ) -> std::io::Result<Self> {
        Self::begin(sink, name, columns, notes).map_err(std::io::Error::other)
    }

    fn begin<'a>(
        sink: W,
        name: &str,
        columns: impl IntoIterator<Item = (&'a str, &'a Column)>,
        notes: &[(&str, String)],
    ) -> Result<Self, ParquetError> {
        let fields = columns.into_iter().map(|(name, column)| field(name, column)).collect::<Result<_, _>>()?;
        let schema = Arc::new(Type::group_type_builder(name).with_fields(fields).build()?);
        let notes = notes.iter().map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone()));
        let notes: Vec<KeyValue> = notes.collect();
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(format!("recrash {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata((!notes.is_empty()).then_some(notes))
            .build();
        Ok(Self { writer: SerializedFileWriter::new(sink, schema, Arc::new(properties))? })
    }

    /// Writes a piece: the columns of [`ParquetWriter::new`] with the next rows.
    ///
    /// # Errors
    /// It cannot be written, or these are other columns.
    pub fn write<'a>(&mut self, columns: impl IntoIterator<Item = &'a Column>) -> std::io::Result<()> {
        self.put(columns).map_err(std::io::Error::other)
    }

    fn put<'a>(&mut self, columns: impl IntoIterator<Item = &'a Column>) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        for column in columns {
            let mut slot = group.next_column()?.ok_or_else(|| ParquetError::General("too few columns".into()))?;
            write_column(slot.untyped(), column)?;
            slot.close()?;
        }
        group.close()?;
        Ok(())
    }

    /// Ends the table.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(self) -> std::io::Result<W> {
        self.writer.into_inner().map_err(std::io::Error::other)
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
