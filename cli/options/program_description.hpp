#pragma once

namespace CLI {
class App;
}

namespace supple::cli {

/// Prints as JSON what tools/make_documents.py makes documents from: the commands and their options, and the
/// options, records, statistics, messages and view files by their descriptions.
void describe_program(const CLI::App& program);

}  // namespace supple::cli
