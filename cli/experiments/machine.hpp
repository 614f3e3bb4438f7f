#pragma once

#include <string>
#include <utility>
#include <vector>

namespace supple::experiments {

/// What times depend on: processor, cores, compiler, version; name and value.
std::vector<std::pair<std::string, std::string>> describe_machine();

}  // namespace supple::experiments
