#pragma once

#include <string>
#include <vector>

namespace supple::cli {

/// Prints the tables of options and statistics for the documents, made from their descriptions. For each
/// table it prints a line `<!-- begin NAME -->`, the table as Markdown, and `<!-- end NAME -->`.
/// tools/generate_docs.sh puts them into the documents.
void print_description_tables();
/// Prints the sections of the viewer's messages as a module of TypeScript, for the reader of the page.
void print_sections();
/// Prints the members of a view file as a module of TypeScript, for the page.
void print_view_members();
/// The keys of all options of scenes and objects, which docs/options.md lists.
std::vector<std::string> keys_of_tables();

}  // namespace supple::cli
