#pragma once

#include <string>
#include <utility>
#include <vector>

namespace supple::experiments {

/// Names and values of the things on which times depend: processor, cores, compiler, version.
std::vector<std::pair<std::string, std::string>> describe_machine();

}  // namespace supple::experiments
