#include "zip_reader.hpp"

#include <zip.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "core/quotes.hpp"

namespace supple {
namespace {

// libzip's own text, without memory that must be freed.
std::string reason(zip_error_t* error) {
  return one_line(zip_error_strerror(error));
}

}  // namespace

void ZipReader::Close::operator()(zip* archive) const {
  zip_discard(archive);
}

std::string ZipReader::lower_case(std::string name) {
  for (char& c : name) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return name;
}

ZipReader::ZipReader(std::string_view bytes, const std::string& archive)
    : archive_name_(archive), most_bytes_((std::uint64_t{16} << 20) + 200 * std::uint64_t{bytes.size()}) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (source != nullptr) {
    archive_.reset(zip_open_from_source(source, ZIP_RDONLY, &error));
    if (!archive_) zip_source_free(source);
  }
  const std::string why = reason(&error);
  zip_error_fini(&error);
  if (!archive_) fail(archive_name_ + ": cannot read the zip archive: " + why);
  const auto count = static_cast<std::uint64_t>(zip_get_num_entries(archive_.get(), 0));
  for (std::uint64_t i = 0; i < count; ++i) {
    if (const char* name = zip_get_name(archive_.get(), i, 0)) indices_.try_emplace(lower_case(name), i);
  }
}

std::string ZipReader::name_ending_with(const std::string& ending) const {
  const auto found =
      std::ranges::find_if(indices_, [&](const auto& entry) { return entry.first.ends_with(ending); });
  if (found == indices_.end())
    fail(archive_name_ + ": the zip archive has no file " + in_quotes("*" + ending));
  return found->first;
}

std::string ZipReader::read(const std::string& name) {
  const auto fail_here = [&](const std::string& what) {
    fail(archive_name_ + ", part " + in_quotes(name) + ": " + what);
  };
  const auto place = indices_.find(lower_case(name));
  if (place == indices_.end()) fail_here("the archive does not contain it");
  const auto close = [](zip_file_t* file) { zip_fclose(file); };
  const std::unique_ptr<zip_file_t, decltype(close)> file(zip_fopen_index(archive_.get(), place->second, 0),
                                                          close);
  if (!file) fail_here("cannot open it: " + reason(zip_get_error(archive_.get())));
  std::string content;
  for (std::array<char, 65536> part;;) {
    const zip_int64_t count = zip_fread(file.get(), part.data(), part.size());
    if (count < 0) fail_here("cannot read it: " + reason(zip_file_get_error(file.get())));
    if (count == 0) return content;
    if (static_cast<std::uint64_t>(count) > most_bytes_)
      fail_here("the archive expands to more than 16 MiB and 200 times its size; compress it less");
    most_bytes_ -= static_cast<std::uint64_t>(count);
    content.append(part.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace supple
