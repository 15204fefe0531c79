#include <cagewright/io/model_file.h>
#include <cagewright/io/read_mesh.h>

#include "io/files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace cagewright {
namespace {

using test::TemporaryFolder;

TEST(ReadMesh, ReadsEveryKindOfFileByItsExtensionInAnyCase) {
  const TemporaryFolder folder;
  for (const test::Sample& sample : test::samples()) {
    for (const std::string extension : {".obj", ".OFF", ".Ply", ".sTL", ".GLB", ".gltf"}) {
      const auto path = folder.add("model" + extension, sample.bytes);
      if (format_of_name(path) == sample.format) {
        const Result<PolygonMesh> mesh = read_mesh(path);
        EXPECT_TRUE(mesh) << mesh.error().message;
      }
    }
  }
}

TEST(ReadMesh, LooksAtTheContentWhenTheExtensionIsWrongOrUnknown) {
  const TemporaryFolder folder;
  for (const test::Sample& sample : test::samples()) {
    for (const char* name : {"model.obj", "model.stl", "model.ply", "model.dat", "model"}) {
      const Result<PolygonMesh> mesh = read_mesh(folder.add(name, sample.bytes));
      EXPECT_TRUE(mesh) << sample.name << " as " << name << ": " << mesh.error().message;
    }
  }
}

TEST(ReadMesh, SaysWhyAFileCannotBeOpened) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::filesystem::path& path, const char* what) {
    const Result<PolygonMesh> mesh = read_mesh(path);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.error().code, ErrorCode::cannot_open);
    EXPECT_EQ(mesh.error().message, path.string() + ": " + what);
  };
  expect(folder / "none.obj", "there is no such file; check the name and the folder");
  expect(folder / "none/none.obj", "there is no such file; check the name and the folder");
  expect(folder.path(), "this is a folder; name a file in it");
  expect("", "there is no such file; check the name and the folder");
  ASSERT_EQ(::mkfifo((folder / "pipe.obj").c_str(), 0600), 0);
  expect(folder / "pipe.obj", "this is not a file but a device or a pipe; save it as a file first");
  expect("/dev/zero", "this is not a file but a device or a pipe; save it as a file first");
  if (::geteuid() != 0) { // root may read everything
    ::chmod(folder.add("secret.obj", "v 0 0 0\n").c_str(), 0);
    expect(folder / "secret.obj", "the file may not be read; change its permissions");
  }
}

TEST(ReadMesh, RefusesFilesBeyondMemoryWithoutReadingThem) {
  const TemporaryFolder folder;
  const auto path = folder.add("huge.obj", "v");
  std::error_code error;
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40U, error); // takes no room on the disk
  if (error) {
    GTEST_SKIP() << "the file system has no sparse files of this size";
  }
  const Result<PolygonMesh> mesh = read_mesh(path);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, ErrorCode::too_large);
  EXPECT_EQ(mesh.error().message,
            path.string() + ": the file has 1099511627776 bytes, and at most 4294967296 can be "
                            "read; simplify the model");
}

TEST(ReadMesh, NamesFilesOfOtherKinds) {
  const TemporaryFolder folder;
  const auto message = [&](std::string_view name, std::string_view bytes) {
    const Result<PolygonMesh> mesh = read_mesh(folder.add(name, bytes));
    EXPECT_FALSE(mesh);
    return mesh ? "read" : mesh.error().message.substr(mesh.error().message.find(": ") + 2);
  };
  EXPECT_EQ(message("a.obj", "\x1f\x8b\x08"), "is a gzip archive; unpack it first");
  EXPECT_EQ(message("a.obj", "PK\x03\x04"),
            "is a zip archive (3MF and USDZ are such); unpack it, or export it as OBJ or GLB");
  EXPECT_EQ(message("a.fbx", "Kaydara FBX Binary"),
            "is an FBX file; export the model as OBJ or GLB");
  EXPECT_EQ(message("a.txt", "once upon a time"),
            "is no mesh in a known format; use OBJ, PLY, STL, OFF, GLB or glTF");
  EXPECT_EQ(message("a.txt", ""), "the file is empty; export the model again");
  EXPECT_EQ(message("a.obj", ""), "the file is empty; export the model again");
}

TEST(ReadMesh, RefusesWhatNothingCanBeMeasuredWith) {
  const auto triangle = [](const std::string& x) {
    return read_mesh("v 0 0 0\nv 1 0 0\nv " + x + " 1 0\nf 1 2 3\n", MeshFormat::obj, "far.obj");
  };
  for (const char* near : {"0", "1e100", "-1e100"}) {
    EXPECT_TRUE(triangle(near)) << near;
  }
  for (const char* far : {"1.1e100", "-1e308"}) {
    const auto mesh = triangle(far);
    ASSERT_FALSE(mesh) << far;
    EXPECT_EQ(mesh.error().message,
              "far.obj: vertex 2, counted from 0, has a coordinate beyond 1e100, with which "
              "nothing can be measured; mend the vertex, or scale the model down");
  }
}

TEST(ReadMesh, KeepsItsMessagesOnOneLineWhateverTheFileIsCalled) {
  EXPECT_EQ(read_mesh(std::filesystem::path("a\nb.obj")).error().message.substr(0, 8), "a?b.obj:");
}

TEST(ReadMesh, ReadsRealModels) {
  const char* models = std::getenv("CAGEWRIGHT_MODELS");
  if (models == nullptr) {
    GTEST_SKIP() << "CAGEWRIGHT_MODELS names no folder";
  }
  struct Known {
    const char* name;
    std::size_t vertices;
    std::size_t faces;
  };
  for (const Known& known : {Known{"bunny.obj", 3301, 6598},
                             {"suzanne.obj", 507, 500},
                             {"spot_quads.obj", 2930, 2928},
                             {"armadillo.off", 26002, 52000},
                             {"pig.stl", 50544, 16848},
                             {"rigged_figure.glb", 370, 256}}) {
    const auto path = std::filesystem::path(models) / known.name;
    if (!std::filesystem::exists(path)) {
      continue;
    }
    const Result<PolygonMesh> mesh = read_mesh(path);
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->positions.size(), known.vertices) << known.name;
    EXPECT_EQ(mesh->face_count(), known.faces) << known.name;
  }
}

TEST(ReadMesh, ShowsARiggedFigureUpright) {
  const char* models = std::getenv("CAGEWRIGHT_MODELS");
  const auto path = std::filesystem::path(models != nullptr ? models : "") / "rigged_figure.glb";
  if (models == nullptr || !std::filesystem::exists(path)) {
    GTEST_SKIP() << "no rigged_figure.glb in the folder that CAGEWRIGHT_MODELS names";
  }
  const Result<PolygonMesh> mesh = read_mesh(path);
  ASSERT_TRUE(mesh) << mesh.error().message;
  Box3 box;
  for (const Vec3& p : mesh->positions) {
    box.extend(p);
  }
  EXPECT_GT(box.sizes().y(), box.sizes().x()); // glTF's y is up: a figure is taller than wide
  EXPECT_GT(box.sizes().y(), 2 * box.sizes().z());
  EXPECT_GT(box.center().y(), 0.5); // and stands on the ground
}

std::string in_utf16(std::string_view text, bool little) {
  std::string bytes = little ? "\xff\xfe" : "\xfe\xff";
  for (const char c : text) {
    bytes.append(little ? std::string{c, '\0'} : std::string{'\0', c});
  }
  return bytes;
}

TEST(ReadMesh, ReadsTextInUtf16AndSaysSo) {
  for (const bool little : {true, false}) {
    const TemporaryFolder folder;
    const Result<ModelFile> file = ModelFile::open(
        folder.add("a.obj", in_utf16("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", little)));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->mesh().positions[2], Vec3(0, 1, 0));
    ASSERT_EQ(file->notes().size(), 1U);
    EXPECT_EQ(file->notes()[0].code, "utf16");
    const std::vector<Vec3> moved = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    ASSERT_TRUE(file->rewrite(moved, {}, folder / "b.obj"));
    EXPECT_EQ(test::bytes_of(folder / "b.obj"), "v 0 0 1\r\nv 1 0 1\r\nv 0 1 1\r\nf 1 2 3\r\n");
  }
}

} // namespace
} // namespace cagewright
