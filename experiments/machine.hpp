#pragma once

#include <string>
#include <utility>
#include <vector>

namespace supple::experiments {

/// Names and values of the things on which results depend: date, commit, processor, compiler, command.
std::vector<std::pair<std::string, std::string>> describe_machine();
/// The same as comments at the start of a CSV file: `# processor: …`.
std::string csv_head();

/// The commit of the sources, `-dirty` after it if files differ from it; `unknown` without git.
const char* commit();

}  // namespace supple::experiments
