#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace supple::experiments {

/// Writes HTML that is also well-formed XML: every element is closed, every text escaped.
class Html {
 public:
  using Attributes = std::vector<std::pair<std::string, std::string>>;

  static std::string escaped(std::string_view text);

  void open(const std::string& tag, const Attributes& attributes = {});
  /// Closes the element opened last.
  void close();
  void text(std::string_view text) { html_ += escaped(text); }
  /// Writes an element that contains only text.
  void element(const std::string& tag, std::string_view text, const Attributes& attributes = {});
  /// Writes an element without content, such as `meta`.
  void empty_element(const std::string& tag, const Attributes& attributes);
  /// Writes text that is already HTML.
  void raw(std::string_view html) { html_ += html; }
  /// Closes all open elements and returns the document.
  std::string finish();

 private:
  void start(const std::string& tag, const Attributes& attributes);

  std::string html_;
  std::vector<std::string> open_;
};

}  // namespace supple::experiments
