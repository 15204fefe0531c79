#include "batch/plan.h"

#include "io/source.h"
#include <cagewright/io/mesh_format.h>

#include <glob.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

namespace cagewright::cli {
namespace {

namespace fs = std::filesystem;

Error nothing_there(const std::string& word) {
  return {ErrorCode::cannot_open, one_line(word) + ": there is no such file, folder or pattern"};
}

bool is_model_name(const fs::path& path) {
  return format_of_name(path).has_value() && path.filename().string().front() != '.';
}

bool is_below(const fs::path& path, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

/// An absolute path without "..", for comparisons: links are not followed.
fs::path plain(const fs::path& path) {
  fs::path whole = fs::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

Status add_folder(const fs::path& folder, const fs::path& out, std::vector<fs::path>& models) {
  std::error_code error;
  std::vector<fs::path> found;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    if (at->is_directory(error) && is_below(plain(at->path()), out)) {
      at.disable_recursion_pending();
    } else if (at->is_regular_file(error) && is_model_name(at->path())) {
      found.push_back(at->path());
    }
  }
  if (error) {
    return Error{ErrorCode::cannot_open, one_line(folder.string()) + ": " + error.message()};
  }
  std::ranges::sort(found);
  models.insert(models.end(), found.begin(), found.end());
  return success();
}

Status add_pattern(const std::string& pattern, std::vector<fs::path>& models) {
  glob_t found{};
  const bool any = glob(pattern.c_str(), 0, nullptr, &found) == 0;
  for (std::size_t i = 0; any && i < found.gl_pathc; ++i) {
    const fs::path path = found.gl_pathv[i];
    if (fs::is_regular_file(path) && is_model_name(path)) {
      models.push_back(path);
    }
  }
  globfree(&found);
  return any ? success()
             : Status(
                   Error{ErrorCode::cannot_open, one_line(pattern) + ": no file has such a name"});
}

void add_lines(std::istream& lines, const fs::path& folder, std::vector<fs::path>& models) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string line;
  for (bool is_first = true; std::getline(lines, line); is_first = false) {
    if (is_first && line.starts_with(byte_order_mark)) { // as editors of Windows write it
      line.erase(0, byte_order_mark.size());
    }
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    line.erase(std::find_if_not(line.rbegin(), line.rend(), is_blank).base(), line.end());
    line.erase(line.begin(), std::ranges::find_if_not(line, is_blank));
    if (!line.empty() && line.front() != '#') {
      models.push_back(folder / line);
    }
  }
}

Status add_word(const std::string& word, const fs::path& out, std::vector<fs::path>& models) {
  std::error_code none;
  if (word == "-") {
    add_lines(std::cin, "", models);
    return success();
  }
  if (fs::is_directory(word, none)) {
    return add_folder(word, out, models);
  }
  if (!fs::exists(word, none)) {
    return word.find_first_of("*?[") != std::string::npos ? add_pattern(word, models)
                                                          : nothing_there(word);
  }
  if (is_model_name(word)) {
    models.emplace_back(word);
    return success();
  }
  std::ifstream lines(word);
  if (!lines) {
    return Error{ErrorCode::cannot_open, one_line(word) + ": this list cannot be read"};
  }
  add_lines(lines, fs::path(word).parent_path(), models);
  return success();
}

/// The folder that all paths are in.
fs::path shared_folder(const std::vector<fs::path>& paths) {
  fs::path shared = paths.front().parent_path();
  for (const fs::path& path : paths) {
    while (!is_below(path, shared)) {
      shared = shared.parent_path();
    }
  }
  return shared;
}

} // namespace

Result<std::vector<BatchJob>> plan_batch(const std::vector<std::string>& words, const fs::path& out,
                                         const std::string& extension) {
  const fs::path folder = plain(out);
  std::vector<fs::path> found;
  for (const std::string& word : words) {
    if (Status added = add_word(word, folder, found); !added) {
      return added.error();
    }
  }
  std::set<fs::path> seen;
  std::vector<fs::path> models; // each once
  std::vector<fs::path> whole;  // the same, absolute
  for (const fs::path& model : found) {
    if (const fs::path path = plain(model); seen.insert(path).second) {
      models.push_back(model);
      whole.push_back(path);
    }
  }
  if (models.empty()) {
    return Error{ErrorCode::cannot_open,
                 "no model is there; OBJ, PLY, STL, OFF, GLB and glTF files are models"};
  }
  const fs::path root = shared_folder(whole);
  std::map<fs::path, int> uses = {{"batch" + extension, 1}}; // its report would be our table
  for (const fs::path& path : whole) {
    ++uses[path.lexically_relative(root).replace_extension(extension)];
  }
  std::vector<BatchJob> jobs;
  std::set<fs::path> cages;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const fs::path name = whole[i].lexically_relative(root);
    fs::path cage = fs::path(name).replace_extension(extension);
    if (uses[cage] > 1) {
      cage = name.string() + extension;
    }
    if (!cages.insert(cage).second) {
      return Error{ErrorCode::invalid_option, "two models would both have their cage in " +
                                                  one_line((out / cage).string()) +
                                                  "; rename one, or run them apart"};
    }
    jobs.push_back(
        {models[i], name.string(), out / cage, out / fs::path(cage).replace_extension(".json")});
  }
  return jobs;
}

} // namespace cagewright::cli
