#include "xdmf_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string_view>

#include "layout.hpp"
#include "supple/error.hpp"
#include "text.hpp"

namespace supple {
namespace {

constexpr std::string_view opening_tags =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<Xdmf Version=\"2.0\">\n<Domain>\n"
    "<Grid Name=\"recording\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
constexpr std::string_view closing_tags = "</Grid>\n</Domain>\n</Xdmf>\n";
/// The text of a frame of many objects is long, so frames wait as times, and their text is made in pieces.
constexpr std::size_t enough_text = std::size_t{1} << 20;

/// The number of bytes of the first UTF-8 character, or 0 when it is invalid or not allowed in XML.
std::size_t character_length(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return 0;
  }
  const auto second = static_cast<unsigned char>(text[1]);
  const bool allowed = !(lead == 0xe0 && second < 0xa0) && !(lead == 0xed && second > 0x9f) &&
                       !(lead == 0xf0 && second < 0x90) && !(lead == 0xf4 && second > 0x8f) &&
                       !(lead == 0xef && second == 0xbf && static_cast<unsigned char>(text[2]) >= 0xbe);
  return allowed ? length : 0;
}

/// Escapes text for use within XML quotes. Characters that XML cannot contain become question marks.
std::string escaped(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) {
      result += '?';
    } else if (text[0] == '&') {
      result += "&amp;";
    } else if (text[0] == '<') {
      result += "&lt;";
    } else if (text[0] == '>') {
      result += "&gt;";
    } else if (text[0] == '"') {
      result += "&quot;";
    } else {
      result += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

[[noreturn]] void fail_to_write(const std::filesystem::path& path) {
  throw Error(path.string() + ": cannot write: " + std::strerror(errno) +
              "; choose a file in a folder that exists and is yours");
}

}  // namespace

XdmfFile::XdmfFile(const std::filesystem::path& path, const std::filesystem::path& recording,
                   const RecordingHeader& header)
    : path_(path) {
  for (std::size_t place = 0; place < header.objects.size(); ++place) {
    const RecordedObject& object = header.objects[place];
    const RecordedElsewhere where = object.elsewhere.value_or(
        RecordedElsewhere{0, object.rest_positions.size(), object.triangles.size()});
    if (where.triangles == 0) continue;
    const std::string triangles = std::to_string(where.triangles);
    const std::string vertices = std::to_string(where.vertices);
    const std::string source =
        escaped(file_of_rank(recording, where.rank).filename().string()) + ":/" + object_path(place);
    Grid grid;
    grid.before_frame = "<Grid Name=\"" + escaped(object.options.name) +
                        "\" GridType=\"Uniform\">\n<Topology TopologyType=\"Triangle\" NumberOfElements=\"" +
                        triangles + "\">\n<DataItem Dimensions=\"" + triangles +
                        " 3\" NumberType=\"UInt\" Precision=\"4\" Format=\"HDF\">" + source +
                        "/triangles</DataItem>\n</Topology>\n<Geometry GeometryType=\"XYZ\">\n"
                        "<DataItem ItemType=\"HyperSlab\" Dimensions=\"1 " +
                        vertices + " 3\">\n<DataItem Dimensions=\"3 3\" NumberType=\"Int\" Format=\"XML\">";
    grid.before_frame_count = " 0 0 1 1 1 1 " + vertices + " 3</DataItem>\n<DataItem Dimensions=\"";
    grid.rest = " " + vertices + " 3\" NumberType=\"Float\" Precision=\"8\" Format=\"HDF\">" + source +
                "/positions</DataItem>\n</DataItem>\n</Geometry>\n</Grid>\n";
    grid.moves = !object.options.is_static;
    grids_.push_back(std::move(grid));
  }
}

XdmfFile::~XdmfFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void XdmfFile::write() {
  if (descriptor_ < 0) {
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail_to_write(path_);
    text_ = opening_tags;
    write_text();
  }
  while (!pending_.empty()) {
    text_.clear();
    std::size_t count = 0;
    for (; count < pending_.size() && text_.size() < enough_text; ++count)
      append_text(frames_ + count, pending_[count]);
    write_text();
    frames_ += count;
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
  }
}

void XdmfFile::append_text(std::uint64_t frame, double time) {
  text_ +=
      "<Grid GridType=\"Collection\" CollectionType=\"Spatial\">\n<Time Value=\"" + to_text(time) + "\"/>\n";
  for (const Grid& grid : grids_) {
    text_ += grid.before_frame + std::to_string(grid.moves ? frame : 0) + grid.before_frame_count +
             std::to_string(grid.moves ? frame + 1 : 1) + grid.rest;
  }
  text_ += "</Grid>\n";
}

void XdmfFile::write_text() {
  const std::size_t longer_by = text_.size();
  text_ += closing_tags;
  std::size_t done = 0;
  while (done < text_.size()) {
    const ssize_t written =
        pwrite(descriptor_, text_.data() + done, text_.size() - done, static_cast<off_t>(end_ + done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write(path_);
    done += static_cast<std::size_t>(written);
  }
  end_ += longer_by;
}

}  // namespace supple
