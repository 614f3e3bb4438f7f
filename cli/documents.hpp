#pragma once

#include <string>

namespace CLI {
class App;
}

namespace supple::cli {

/// Prints a document about the program to standard output, made from its definitions of options: `man`
/// (roff), `markdown`, or the `tables` of other documents. Throws `CLI::ValidationError` for another name.
void print_document(const CLI::App& program, const std::string& name);

}  // namespace supple::cli
