#include "info.hpp"

namespace supple::cli {

int run_info(const InfoOptions&) {
  return 0;
}

}  // namespace supple::cli
