"""Parts of the reader of tables: cells, columns, times."""
