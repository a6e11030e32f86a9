//! Tables that leave by the Arrow PyCapsule interface: pyarrow, polars, pandas and DuckDB take them without a copy.

use crate::errors::{input, to_python};
use arrow_array::builder::{BooleanBuilder, Float64Builder, Int64Builder, StringBuilder};
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator, StringArray};
use arrow_schema::ffi::FFI_ArrowSchema;
use arrow_schema::{DataType, Field, Schema, SchemaRef};
use pyo3::prelude::*;
use pyo3::types::{PyCapsule, PyDict, PyList};
use recrash_pipeline::{Column, RecordTable};
use serde_json::Value;
use std::sync::Arc;

/// A table of columns.
#[pyclass(frozen, module = "recrash")]
pub struct Table {
    schema: SchemaRef,
    /// Rows, one batch behind the other: tables are put together without a copy.
    batches: Vec<RecordBatch>,
}

#[pymethods]
impl Table {
    /// A table of dicts; its columns are the keys, in the order of their first use. What is neither number, text nor yes or no
    /// becomes JSON.
    #[staticmethod]
    fn of_rows(rows: &Bound<'_, PyList>) -> PyResult<Self> {
        let py = rows.py();
        let text = crate::errors::to_json(rows.as_any())?;
        let rows: Vec<serde_json::Map<String, Value>> =
            serde_json::from_str(&text).map_err(|error| input(py, error))?;
        let mut names: Vec<&String> = Vec::new();
        for name in rows.iter().flat_map(|row| row.keys()) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let columns = names.iter().map(|name| ((*name).clone(), column_of(rows.iter().map(|row| row.get(*name)))));
        Self::of_arrays(py, columns.collect())
    }

    /// The rows of several tables of the same columns, one table behind the other, without a copy.
    #[staticmethod]
    fn concat(py: Python<'_>, tables: Vec<Bound<'_, Self>>) -> PyResult<Self> {
        let first = tables.first().ok_or_else(|| input(py, "there is no table to put together"))?.get();
        let other = tables.iter().position(|table| table.get().schema != first.schema);
        if let Some(number) = other {
            return Err(input(py, format!("table {number} has other columns than the first")));
        }
        let batches = tables.iter().flat_map(|table| table.get().batches.clone()).collect();
        Ok(Self { schema: Arc::clone(&first.schema), batches })
    }

    /// Names of the columns.
    #[getter]
    fn column_names(&self) -> Vec<String> {
        self.schema.fields().iter().map(|field| field.name().clone()).collect()
    }

    /// Rows, and columns.
    #[getter]
    fn shape(&self) -> (usize, usize) {
        (self.__len__(), self.schema.fields().len())
    }

    /// Its first rows, without a copy.
    fn head(&self, rows: usize) -> Self {
        let mut left = rows;
        let batches = self.batches.iter().map_while(|batch| {
            let taken = left.min(batch.num_rows());
            left -= taken;
            (taken > 0 || rows == 0).then(|| batch.slice(0, taken))
        });
        Self { schema: Arc::clone(&self.schema), batches: batches.collect() }
    }

    /// Its rows as dicts.
    fn to_dicts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let names = self.column_names();
        let row = |batch: &RecordBatch, row: usize| {
            let cells = names.iter().zip(batch.columns());
            Value::Object(cells.map(|(name, column)| (name.clone(), value(column, row))).collect())
        };
        let rows = self.batches.iter().flat_map(|batch| (0..batch.num_rows()).map(|number| row(batch, number)));
        to_python(py, &rows.collect::<Vec<Value>>())
    }

    /// Its columns as lists, by name.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for (number, name) in self.column_names().into_iter().enumerate() {
            let of = |batch: &RecordBatch| -> Vec<Value> {
                (0..batch.num_rows()).map(|row| value(batch.column(number), row)).collect()
            };
            let values: Vec<Value> = self.batches.iter().flat_map(of).collect();
            all.set_item(name, to_python(py, &values)?)?;
        }
        Ok(all)
    }

    /// Pickled as its columns, each with its kind: a column of nothing keeps it.
    #[allow(clippy::type_complexity, reason = "Python's protocol: a callable and its arguments")]
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, (Vec<(String, String)>, usize, Bound<'py, PyDict>))> {
        let restore = py.get_type::<Self>().getattr("_restore")?;
        let fields = self.schema.fields();
        let kinds = fields.iter().map(|field| (field.name().clone(), kind_name(field.data_type()).to_owned()));
        Ok((restore, (kinds.collect(), self.__len__(), self.to_dict(py)?)))
    }

    /// What `pickle` calls.
    #[staticmethod]
    fn _restore(
        py: Python<'_>,
        kinds: Vec<(String, String)>,
        rows: usize,
        values: &Bound<'_, PyDict>,
    ) -> PyResult<Self> {
        let mut columns = Vec::new();
        for (name, kind) in kinds {
            let of = values.get_item(&name)?.ok_or_else(|| input(py, format!("the pickled table lacks {name}")))?;
            let column = match kind.as_str() {
                "flag" => Column::Flag(of.extract()?),
                "whole" => Column::Whole(of.extract()?),
                "number" => Column::Number(of.extract()?),
                _ => Column::Text(of.extract()?),
            };
            columns.push((name, array(column)));
        }
        let table = Self::of_arrays(py, columns)?;
        match table.__len__() == rows {
            true => Ok(table),
            false => Err(input(py, format!("the pickled table has {} rows, not {rows}", table.__len__()))),
        }
    }

    /// A table never changes: a copy is itself.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    /// A table never changes: a copy is itself.
    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// The Arrow PyCapsule interface.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // Another schema is a wish, which the interface lets a producer pass over.
        drop(requested_schema);
        let batches: Vec<_> = self.batches.iter().cloned().map(Ok).collect();
        let reader = RecordBatchIterator::new(batches, Arc::clone(&self.schema));
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(Box::new(reader)), c"arrow_array_stream")
    }

    /// The Arrow PyCapsule interface.
    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(&*self.schema).map_err(|error| input(py, error))?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    fn __len__(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    fn __repr__(&self) -> String {
        format!("Table({} rows: {})", self.__len__(), self.column_names().join(", "))
    }

    /// Its first rows, for a terminal.
    fn __str__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("recrash._show")?.call_method1("table_text", (slf,))
    }

    /// Its first rows, for a notebook.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("recrash._show")?.call_method1("table_html", (slf,))
    }
}

impl Table {
    /// From columns of the library.
    pub fn of_columns(py: Python<'_>, columns: Vec<(&'static str, Column)>) -> PyResult<Self> {
        Self::of_arrays(py, columns.into_iter().map(|(name, column)| (name.to_owned(), array(column))).collect())
    }

    /// From columns with names that are made.
    pub fn of_named(py: Python<'_>, columns: Vec<(String, Column)>) -> PyResult<Self> {
        Self::of_arrays(py, columns.into_iter().map(|(name, column)| (name, array(column))).collect())
    }

    /// From a table of the library.
    pub fn of_table(py: Python<'_>, table: RecordTable) -> PyResult<Self> {
        Self::of_columns(py, table.columns)
    }

    fn of_arrays(py: Python<'_>, columns: Vec<(String, ArrayRef)>) -> PyResult<Self> {
        let fields = columns.iter().map(|(name, array)| Field::new(name, array.data_type().clone(), true));
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let arrays: Vec<ArrayRef> = columns.into_iter().map(|(_, array)| array).collect();
        let rows = arrays.first().map_or(0, |array| array.len());
        let options = arrow_array::RecordBatchOptions::new().with_row_count(Some(rows));
        let batch = RecordBatch::try_new_with_options(Arc::clone(&schema), arrays, &options);
        Ok(Self { schema, batches: vec![batch.map_err(|error| input(py, error))?] })
    }

    /// The same table; its columns are shared.
    pub fn copy(&self) -> Self {
        Self { schema: Arc::clone(&self.schema), batches: self.batches.clone() }
    }
}

fn array(column: Column) -> ArrayRef {
    match column {
        Column::Text(values) => Arc::new(StringArray::from_iter(values)),
        Column::Whole(values) => Arc::new(Int64Array::from_iter(values)),
        Column::Number(values) => Arc::new(Float64Array::from_iter(values)),
        Column::Flag(values) => Arc::new(BooleanArray::from_iter(values)),
    }
}

/// The kind of a column of this module, by name.
fn kind_name(kind: &DataType) -> &'static str {
    match kind {
        DataType::Boolean => "flag",
        DataType::Int64 => "whole",
        DataType::Float64 => "number",
        _ => "text",
    }
}

/// A column of JSON values: of the narrowest kind that holds all.
fn column_of<'a>(values: impl Iterator<Item = Option<&'a Value>> + Clone) -> ArrayRef {
    let told = values.clone().flatten().filter(|value| !value.is_null());
    let (mut flags, mut whole, mut numbers) = (true, true, true);
    let mut any = false;
    for value in told {
        any = true;
        flags &= value.is_boolean();
        whole &= value.is_i64();
        numbers &= value.is_number();
    }
    if any && flags {
        let mut builder = BooleanBuilder::new();
        values.for_each(|value| builder.append_option(value.and_then(Value::as_bool)));
        Arc::new(builder.finish())
    } else if any && whole {
        let mut builder = Int64Builder::new();
        values.for_each(|value| builder.append_option(value.and_then(Value::as_i64)));
        Arc::new(builder.finish())
    } else if any && numbers {
        let mut builder = Float64Builder::new();
        values.for_each(|value| builder.append_option(value.and_then(Value::as_f64)));
        Arc::new(builder.finish())
    } else {
        let mut builder = StringBuilder::new();
        values.for_each(|value| {
            builder.append_option(value.filter(|value| !value.is_null()).map(|value| match value {
                Value::String(text) => text.clone(),
                other => other.to_string(),
            }));
        });
        Arc::new(builder.finish())
    }
}

/// One value of an array that this module made.
fn value(array: &ArrayRef, row: usize) -> Value {
    use arrow_array::cast::AsArray;
    use arrow_array::types::{Float64Type, Int64Type};
    if array.is_null(row) {
        return Value::Null;
    }
    match array.data_type() {
        DataType::Utf8 => Value::from(array.as_string::<i32>().value(row)),
        DataType::Int64 => Value::from(array.as_primitive::<Int64Type>().value(row)),
        DataType::Float64 => Value::from(array.as_primitive::<Float64Type>().value(row)),
        DataType::Boolean => Value::from(array.as_boolean().value(row)),
        _ => Value::Null,
    }
}
