#pragma once

#include <string>

namespace supple::cli {

/// Opens an address in the user's browser, where there is a screen; does nothing otherwise, or when there is
/// no browser.
void open_browser(const std::string& url);

}  // namespace supple::cli
