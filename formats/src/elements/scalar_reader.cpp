#include "elements/scalar_reader.hpp"

#include "core/error.hpp"
#include "files/byte_order.hpp"

namespace supple {

std::size_t size_of(Scalar type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[static_cast<int>(type)];
}

template <class Stored>
Stored ScalarReader::load(const char* what) {
  last_value_ = text.offset();
  if (text.remaining() < sizeof(Stored)) fail_here(std::string("the file ends before ") + what);
  const char* place = bytes_.data() + text.offset();
  text.skip_bytes(sizeof(Stored));
  return load_scalar<Stored>(place,
                             encoding_ == Encoding::big_endian ? std::endian::big : std::endian::little);
}

void ScalarReader::skip_to_value(const char* what) {
  if (!text.skip_to_word()) text.fail_here(std::string("the file ends before ") + what);
}

double ScalarReader::number(Scalar type, const char* what) {
  if (encoding_ == Encoding::text) {
    skip_to_value(what);
    return text.number(what);
  }
  if (type == Scalar::float32) return static_cast<double>(load<float>(what));
  if (type == Scalar::float64) return load<double>(what);
  return static_cast<double>(integer(type, what));
}

std::int64_t ScalarReader::integer(Scalar type, const char* what) {
  if (encoding_ == Encoding::text) {
    skip_to_value(what);
    return text.integer(what);
  }
  switch (type) {
    case Scalar::int8:
      return load<std::int8_t>(what);
    case Scalar::uint8:
      return load<std::uint8_t>(what);
    case Scalar::int16:
      return load<std::int16_t>(what);
    case Scalar::uint16:
      return load<std::uint16_t>(what);
    case Scalar::int32:
      return load<std::int32_t>(what);
    case Scalar::uint32:
      return load<std::uint32_t>(what);
    default:
      return load<std::int64_t>(what);
  }
}

std::uint64_t ScalarReader::count(Scalar type, const char* what) {
  const std::int64_t value = integer(type, what);
  if (value < 0) fail_here(std::string(what) + " is " + std::to_string(value));
  return static_cast<std::uint64_t>(value);
}

void ScalarReader::skip(Scalar type, std::uint64_t count, const char* what) {
  if (encoding_ == Encoding::text) {
    for (std::uint64_t i = 0; i < count; ++i) {
      skip_to_value(what);
      text.word();
    }
  } else {
    expect(count, 1, type, what);
    text.skip_bytes(count * size_of(type));
  }
}

void ScalarReader::expect(std::uint64_t count, std::uint64_t values, Scalar type, const char* what) const {
  // In a text, a number has a digit and a blank, which may be missing after the last.
  const bool is_text = encoding_ == Encoding::text;
  const std::uint64_t most = is_text ? (text.remaining() + 1) / 2 : text.remaining() / size_of(type);
  if (values != 0 && count > most / values) {
    fail_here("announces " + std::to_string(count) + " of " + what +
              ", more than the rest of the file can hold");
  }
}

void ScalarReader::fail_here(const std::string& message) const {
  if (encoding_ == Encoding::text) text.fail_here(message);
  fail(file_ + ", byte " + std::to_string(last_value_) + ": " + message);
}

}  // namespace supple
