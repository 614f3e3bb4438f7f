#pragma once

#include <string>
#include <string_view>

namespace supple {

/// XML of any encoding as Assimp reads it: UTF-8. Of UTF-16, it would see an empty file.
std::string xml_in_utf8(std::string_view bytes, const std::string& file);

/// A COLLADA file as Assimp reads it safely: UTF-8, without blanks around numbers. Fails when an array is
/// shorter than an accessor needs, for which Assimp reads memory outside of it. `bytes` may be a zip archive
/// (.zae).
std::string collada_text(std::string_view bytes, const std::string& file);

}  // namespace supple
