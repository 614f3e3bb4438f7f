#include "html.hpp"

namespace supple::experiments {

std::string Html::escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

void Html::start(const std::string& tag, const Attributes& attributes) {
  html_ += '<' + tag;
  for (const auto& [name, value] : attributes) html_ += ' ' + name + "=\"" + escaped(value) + '"';
}

void Html::open(const std::string& tag, const Attributes& attributes) {
  start(tag, attributes);
  html_ += ">\n";
  open_.push_back(tag);
}

void Html::close() {
  html_ += "</" + open_.back() + ">\n";
  open_.pop_back();
}

void Html::element(const std::string& tag, std::string_view text, const Attributes& attributes) {
  start(tag, attributes);
  html_ += '>' + escaped(text) + "</" + tag + ">\n";
}

void Html::empty_element(const std::string& tag, const Attributes& attributes) {
  start(tag, attributes);
  html_ += "/>\n";
}

std::string Html::finish() {
  while (!open_.empty()) close();
  return std::move(html_);
}

}  // namespace supple::experiments
