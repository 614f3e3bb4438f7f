#pragma once

namespace supple::cli {

/// Prints the tables of options and statistics that the documents contain, made from their descriptions: a
/// line `<!-- begin NAME -->`, the table as Markdown, and `<!-- end NAME -->`, for each.
/// tools/generate_docs.sh puts them into the documents.
void print_description_tables();

}  // namespace supple::cli
