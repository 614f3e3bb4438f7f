#pragma once

#include <string>

namespace CLI {
class App;
}

namespace supple::cli {

/// Prints a document about the program to standard output, made from the definitions of its options. `name`
/// is `man` (roff), `markdown`, or `tables` (of other documents). Throws `CLI::ValidationError` for another
/// name.
void print_document(const CLI::App& program, const std::string& name);

}  // namespace supple::cli
