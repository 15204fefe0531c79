// Any bytes as a file of weights: NumPy's archives, CSV, JSON, DMAT. What is read fits together,
// and moves a model.
#include "require.h"

#include <cagewright/deform/deformer.h>
#include <cagewright/deform/weights_file.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace {

using namespace cagewright;
using fuzz::require;
using fuzz::require_one_line;

constexpr std::size_t most_weights = 1 << 22;

/// Bytes as a file that has a name.
class FileInMemory {
public:
  FileInMemory(const std::uint8_t* data, std::size_t size)
      : descriptor_(::memfd_create("weights", 0)),
        path_("/proc/self/fd/" + std::to_string(descriptor_)) {
    require(::write(descriptor_, data, size) == static_cast<ssize_t>(size), "the file is written");
  }
  ~FileInMemory() { ::close(descriptor_); }
  FileInMemory(const FileInMemory&) = delete;
  FileInMemory& operator=(const FileInMemory&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

private:
  int descriptor_;
  std::string path_;
};

/// A short CSV may say that a million vertices have no weights: it is read, and takes its time.
bool promises_much(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view mark = "# model ";
  for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at + 1)) {
    const std::string_view number = text.substr(at + mark.size());
    if (std::min(number.find_first_not_of("0123456789"), number.size()) > 5) {
      return true;
    }
  }
  return false;
}

void check(StoredWeights stored) {
  require(stored.weights.points() * stored.weights.columns() <= most_weights,
          "a small file has few weights");
  for (const Index corner : stored.cage.corners()) {
    require(corner < stored.cage.positions.size(), "corners are vertices");
  }
  PolygonMesh model;
  model.positions.assign(stored.weights.points(), Vec3(0.1, 0.2, 0.3));
  if (const Status belongs = belongs_to(stored, model.positions, stored.cage); !belongs) {
    require_one_line(belongs.error().message);
  }
  if (!stored.has_identity) {
    return;
  }
  auto rule = stored.settings.kind().rule(stored.cage, stored.settings);
  require(rule.has_value(), "the cage of a file is one for its kind");
  Result<Deformer> deformer = Deformer::from_weights(model, *rule, std::move(stored.weights));
  require(deformer.has_value(), "weights of a file can be used");
  std::vector<Vec3> cage = stored.cage.positions;
  for (Vec3& p : cage) {
    p += Vec3(1, 0, 0);
  }
  deformer->set_cage(cage);
  deformer->update();
  require(deformer->positions().size() == model.positions.size(), "the model keeps its vertices");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (promises_much(data, size)) {
    return -1;
  }
  const FileInMemory file(data, size);
  Result<StoredWeights> stored = read_weights(file.path());
  if (!stored) {
    require_one_line(stored.error().message);
    return 0;
  }
  check(std::move(*stored));
  return 0;
}
