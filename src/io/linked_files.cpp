#include "io/linked_files.h"

#include "io/gltf_document.h"
#include "io/read_file.h"
#include "io/source.h"
#include "io/text_cursor.h"
#include "io/uri.h"
#include <cagewright/io/mesh_format.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace cagewright {
namespace {

namespace fs = std::filesystem;

/// The names of files, of which those that exist are kept.
class Links {
public:
  explicit Links(fs::path folder) : folder_(std::move(folder)) {}

  bool add(const fs::path& name) {
    std::error_code ignored;
    if (name.empty() || name.is_absolute() || !fs::exists(folder_ / name, ignored)) {
      return false;
    }
    if (std::find(found_.begin(), found_.end(), name) == found_.end()) {
      found_.push_back(name);
    }
    return true;
  }

  /// A name with blanks in it, or several names: what exists tells.
  void add_line(std::string_view line) {
    if (add(fs::path(line))) {
      return;
    }
    while (!line.empty()) {
      const std::size_t blank = std::min(line.find_first_of(" \t"), line.size());
      add(fs::path(line.substr(0, blank)));
      line.remove_prefix(std::min(blank + 1, line.size()));
    }
  }

  std::vector<fs::path> take() && { return std::move(found_); }

private:
  fs::path folder_;
  std::vector<fs::path> found_;
};

void find_in_obj(const Source& source, Links& links) {
  TextCursor cursor(source);
  for (; cursor.next_word_of_file(); cursor.next_line()) {
    if (cursor.word() == "mtllib") {
      links.add_line(cursor.rest_of_line());
    }
  }
}

void find_in_ply(const Source& source, Links& links) {
  constexpr std::string_view start = "comment TextureFile ";
  const std::string_view header = source.bytes.substr(0, source.bytes.find("end_header"));
  for (std::size_t at = header.find(start); at != header.npos; at = header.find(start, at + 1)) {
    const std::string_view line = header.substr(at + start.size());
    links.add_line(line.substr(0, line.find_first_of("\r\n")));
  }
}

void find_in_gltf(const Source& source, Links& links) {
  const Result<GltfDocument> document = GltfDocument::open(source, std::nullopt);
  if (!document) {
    return;
  }
  const Json& images = member(document->json(), "images");
  for (std::size_t i = 0; images.is_array() && i < images.size(); ++i) {
    const std::string uri = to_text(member(images[i], "uri"));
    if (!is_data_uri(uri)) {
      links.add(decode_percent(uri));
    }
  }
}

} // namespace

std::vector<fs::path> linked_files(const fs::path& model) {
  const Result<FileBytes> file = read_file(model);
  if (!file) {
    return {};
  }
  const std::string name = model.string();
  const Source source{name, file->view()};
  Links links(model.parent_path());
  switch (
      format_of_content(source.bytes).value_or(format_of_name(model).value_or(MeshFormat::stl))) {
  case MeshFormat::obj:
    find_in_obj(source, links);
    break;
  case MeshFormat::ply:
    find_in_ply(source, links);
    break;
  case MeshFormat::gltf:
    find_in_gltf(source, links);
    break;
  case MeshFormat::off:
  case MeshFormat::stl:
    break;
  }
  return std::move(links).take();
}

} // namespace cagewright
