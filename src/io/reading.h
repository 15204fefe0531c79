/// \file
/// What a reader tells and fills beside the mesh.
#pragma once

#include "io/source.h"
#include <cagewright/io/mesh_attributes.h>
#include <cagewright/io/model_file.h>
#include <cagewright/io/pose.h>
#include <cagewright/io/rewrite_positions.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace cagewright {

/// The notes of one file: each kind once, with its first place and a count.
class NoteList {
public:
  /// \param place  "file:7" or "file: byte 80", from Source::place_in_line() and the like; taken
  ///               for the first of a kind only
  /// \param what   what the file has and what was made of it
  template <class Place> void add(std::string_view code, Place place, std::string_view what) {
    for (Kind& kind : kinds_) {
      if (kind.code == code) {
        ++kind.count;
        return;
      }
    }
    kinds_.push_back({std::string(code), place() + ": " + std::string(what), 1});
  }

  /// "file:7: ... (and 3 more)", in the order in which the kinds were met.
  [[nodiscard]] std::vector<FileNote> take() const {
    std::vector<FileNote> notes;
    for (const Kind& kind : kinds_) {
      notes.push_back({kind.code, kind.count == 1 ? kind.message
                                                  : kind.message + " (and " +
                                                        std::to_string(kind.count - 1) + " more)"});
    }
    return notes;
  }

private:
  struct Kind {
    std::string code;
    std::string message;
    std::size_t count;
  };
  std::vector<Kind> kinds_; // a handful
};

/// What read_mesh() and its like want of a reader beside the mesh.
struct Reading {
  Pose pose = Pose::shown; ///< of a rigged model
  NoteList notes;
  FileNormals* normals = nullptr;       ///< to be filled, or null
  MeshAttributes* attributes = nullptr; ///< to be filled, or null
};

} // namespace cagewright
