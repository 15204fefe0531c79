#include <cagewright/io/model_file.h>
#include <cagewright/io/read_mesh.h>

#include "io/files.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace cagewright {
namespace {

using Faces = std::vector<std::vector<Index>>;
using test::binary;

// The parts of a small file; every test changes what it is about. The triangle (0 0 0) (1 0 0)
// (0 1 0) is at the start of the binary chunk, then come four shorts 0 1 2 3 and a fourth point.
struct Parts {
  std::string asset = R"({"version":"2.0"})";
  std::string more = ""; // further members of the file
  std::string scenes = R"([{"nodes":[0]}])";
  std::string nodes = R"([{"mesh":0}])";
  std::string primitives = R"([{"attributes":{"POSITION":0}}])";
  std::string accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}])";
  std::string views = R"([{"buffer":0,"byteLength":36}])";
  std::string buffers = R"([{"byteLength":56}])";
  std::string bytes =
      binary(0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F) +
      binary(std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2}, std::uint16_t{3}) +
      binary(1.F, 1.F, 0.F);

  [[nodiscard]] std::string json() const {
    return R"({"asset":)" + asset + R"(,"scenes":)" + scenes + R"(,"nodes":)" + nodes +
           R"(,"meshes":[{"primitives":)" + primitives + R"(}],"accessors":)" + accessors +
           R"(,"bufferViews":)" + views + R"(,"buffers":)" + buffers + more + "}";
  }
};

PolygonMesh read_glb(const Parts& parts) {
  Result<PolygonMesh> mesh =
      test::read(test::make_glb(parts.json(), parts.bytes), MeshFormat::gltf);
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? *std::move(mesh) : PolygonMesh();
}

std::string message_of(const Parts& parts) {
  return test::message_of(test::make_glb(parts.json(), parts.bytes), MeshFormat::gltf);
}

TEST(ReadGltf, ReadsTrianglesWithoutIndices) {
  const PolygonMesh mesh = read_glb({});
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 1, 2}}));
}

TEST(ReadGltf, AppliesTheTransformsOfAllNodesAbove) {
  // Scale, then turn a quarter about z, then move: glTF's order. The parent only moves.
  const PolygonMesh mesh =
      read_glb({.nodes = R"([{"children":[1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]},)"
                         R"({"mesh":0,"translation":[10,0,0],"scale":[2,1,1],)"
                         R"("rotation":[0,0,0.70710678118654752,0.70710678118654752]}])"});
  EXPECT_TRUE(mesh.positions[0].isApprox(Vec3(10, 0, 5)));
  EXPECT_TRUE(mesh.positions[1].isApprox(Vec3(10, 2, 5)));
  EXPECT_TRUE(mesh.positions[2].isApprox(Vec3(9, 0, 5)));
}

TEST(ReadGltf, ShowsAMeshOnceForEveryNode) {
  const PolygonMesh mesh = read_glb(
      {.scenes = R"([{"nodes":[0,1]}])",
       .nodes = R"([{"mesh":0,"name":"left"},{"mesh":0,"translation":[1,0,0]},{"mesh":0}])"});
  EXPECT_EQ(mesh.positions.size(), 6U); // the third node is in no scene
  EXPECT_EQ(mesh.positions[3], Vec3(1, 0, 0));
  EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(mesh.group_names, (std::vector<std::string>{"left", "node 1"}));
  EXPECT_EQ(mesh.face_groups, (std::vector<Index>{0, 1}));
}

TEST(ReadGltf, TurnsMirroredTrianglesBack) {
  EXPECT_EQ(test::faces_of(read_glb({.nodes = R"([{"mesh":0,"scale":[-1,1,1]}])"})),
            (Faces{{0, 2, 1}}));
}

TEST(ReadGltf, ShowsAllRootsWhereThereIsNoScene) {
  EXPECT_EQ(read_glb({.scenes = "[]", .nodes = R"([{"children":[1]},{"mesh":0},{"mesh":0}])"})
                .positions.size(),
            6U);
}

Parts with_indices(const std::string& type, const std::string& indices, int count, int mode = 4) {
  Parts parts;
  parts.primitives =
      R"([{"attributes":{"POSITION":0},"indices":1,"mode":)" + std::to_string(mode) + "}]";
  parts.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
                    R"({"bufferView":1,"type":"SCALAR","count":)" +
                    std::to_string(count) + R"(,"componentType":)" + type + "}]";
  parts.views = R"([{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":)" +
                std::to_string(indices.size()) + "}]";
  parts.bytes = std::string(48, '\0') + indices;
  parts.buffers = R"([{"byteLength":)" + std::to_string(parts.bytes.size()) + "}]";
  return parts;
}

TEST(ReadGltf, KnowsEveryTypeOfIndex) {
  EXPECT_EQ(test::faces_of(read_glb(with_indices("5121", std::string("\2\1\3", 3), 3))),
            (Faces{{2, 1, 3}}));
  EXPECT_EQ(test::faces_of(read_glb(with_indices("5123", std::string("\2\0\1\0\3\0", 6), 3))),
            (Faces{{2, 1, 3}}));
  EXPECT_EQ(test::faces_of(read_glb(with_indices("5125", binary(2, 1, 3), 3))), (Faces{{2, 1, 3}}));
}

TEST(ReadGltf, UnrollsStripsAndFans) {
  EXPECT_EQ(test::faces_of(read_glb(with_indices("5125", binary(0, 1, 2, 3, 3), 5, 5))),
            (Faces{{0, 1, 2}, {1, 3, 2}})); // the last only turns the strip
  EXPECT_EQ(test::faces_of(read_glb(with_indices("5125", binary(0, 1, 2, 3), 4, 6))),
            (Faces{{1, 2, 0}, {2, 3, 0}}));
  EXPECT_NE(message_of(with_indices("5125", binary(0, 1, 2, 3), 4, 1)).find("has no faces"),
            std::string::npos);
}

TEST(ReadGltf, KeepsTrianglesWithRepeatedCorners) {
  EXPECT_EQ(test::faces_of(read_glb(with_indices("5125", binary(0, 0, 2), 3))), (Faces{{0, 0, 2}}));
}

TEST(ReadGltf, SharesTheVerticesOfPrimitives) {
  const PolygonMesh mesh =
      read_glb({.primitives = R"([{"attributes":{"POSITION":0}},{"attributes":{"POSITION":0}}])"});
  EXPECT_EQ(mesh.positions.size(), 3U);
  EXPECT_EQ(test::faces_of(mesh), (Faces{{0, 1, 2}, {0, 1, 2}}));
}

TEST(ReadGltf, StepsOverInterleavedData) {
  std::string bytes = binary(0.F); // byteOffset 4
  for (const auto& p : {std::array{0.F, 0.F, 0.F}, {1.F, 0.F, 0.F}, {0.F, 1.F, 0.F}}) {
    bytes += binary(p[0], p[1], p[2], 9.F, 9.F);
  }
  bytes.resize(bytes.size() - 8); // the last element need not fill its stride
  EXPECT_EQ(
      read_glb({.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
                             R"("byteOffset":4}])",
                .views = R"([{"buffer":0,"byteLength":56,"byteStride":20}])",
                .bytes = bytes})
          .positions,
      (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(ReadGltf, ReadsSmallIntegersAsTheyAreOrAsFractions) {
  const std::string bytes =
      binary(std::int16_t{-32768}, std::int16_t{32767}, std::int16_t{0}, std::int16_t{0},
             std::int16_t{1}, std::int16_t{2}, std::int16_t{3}, std::int16_t{4}, std::int16_t{5});
  Parts parts{.accessors = R"([{"bufferView":0,"componentType":5122,"count":3,"type":"VEC3"}])",
              .bytes = bytes};
  parts.views = R"([{"buffer":0,"byteLength":18}])";
  parts.buffers = R"([{"byteLength":18}])";
  EXPECT_EQ(read_glb(parts).positions[0], Vec3(-32768, 32767, 0));
  parts.accessors.insert(2, R"("normalized":true,)");
  EXPECT_EQ(read_glb(parts).positions[0], Vec3(-1, 1, 0));
  EXPECT_EQ(read_glb(parts).positions[2], Vec3(3 / 32767.0, 4 / 32767.0, 5 / 32767.0));
}

TEST(ReadGltf, AppliesSparseValues) {
  const std::string sparse =
      R"("sparse":{"count":2,"indices":{"bufferView":1,"byteOffset":2,"componentType":5123},)"
      R"("values":{"bufferView":2}}}])";
  Parts parts;
  parts.bytes = parts.bytes + binary(7.F, 8.F, 9.F);
  parts.buffers = R"([{"byteLength":68}])";
  parts.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},)"
                R"({"buffer":0,"byteOffset":44,"byteLength":24}])";
  parts.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)" + sparse;
  EXPECT_EQ(read_glb(parts).positions, (std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {7, 8, 9}}));
  parts.accessors = R"([{"componentType":5126,"count":3,"type":"VEC3",)" + sparse; // over zeros
  EXPECT_EQ(read_glb(parts).positions, (std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {7, 8, 9}}));
  parts.accessors = R"([{"componentType":5126,"count":2,"type":"VEC3",)" + sparse;
  EXPECT_EQ(message_of(parts),
            "file: accessor 0 replaces element 2, but there are 2; export the model again");
}

TEST(ReadGltf, ReadsColorsOfVertices) {
  Parts parts{.primitives = R"([{"attributes":{"POSITION":0,"COLOR_0":1}}])"};
  parts.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
                    R"({"bufferView":1,"componentType":5121,"count":3,"type":"VEC4",)"
                    R"("normalized":true}])";
  parts.views = R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":12}])";
  parts.bytes.replace(36, 12, std::string("\xff\x33\0\xff\0\0\0\0\0\0\0\xff", 12));
  EXPECT_EQ(read_glb(parts).colors[0], (std::array<float, 4>{1, 0.2F, 0, 1}));
}

TEST(ReadGltf, LooksForBuffersBesideTheFile) {
  const test::TemporaryFolder folder;
  Parts parts{.buffers = R"([{"byteLength":36,"uri":"with%20blank.bin"}])"};
  folder.add("with blank.bin", parts.bytes.substr(0, 36));
  const Result<PolygonMesh> mesh = read_mesh(folder.add("model.gltf", parts.json()));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->positions[1], Vec3(1, 0, 0));
  folder.add("with blank.bin", parts.bytes.substr(0, 35));
  EXPECT_EQ(read_mesh(folder / "model.gltf").error().message,
            (folder / "model.gltf").string() +
                ": buffer 0 should have 36 bytes, but has 35; export the model again");
  std::filesystem::remove(folder / "with blank.bin");
  EXPECT_EQ(read_mesh(folder / "model.gltf").error().code, ErrorCode::cannot_open);
}

TEST(ReadGltf, FindsBuffersByNamesThatAreNoUris) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "sub");
  const std::string bytes = Parts().bytes.substr(0, 36);
  folder.add("100%25.bin", bytes); // stands so in the URI, unescaped
  folder.add("sub/a b.bin", bytes);
  for (const std::string uri : {"100%25.bin", R"(sub\\a b.bin)", "./sub/a%20b.bin"}) {
    const Parts parts{.buffers = R"([{"byteLength":36,"uri":")" + uri + "\"}]"};
    const Result<PolygonMesh> mesh = read_mesh(folder.add("model.gltf", parts.json()));
    EXPECT_TRUE(mesh) << uri << ": " << mesh.error().message;
  }
}

TEST(ReadGltf, ReadsDataUrisOfAllKinds) {
  const auto with_uri = [](const std::string& uri) {
    return Parts{.buffers = R"([{"byteLength":36,"uri":")" + uri + "\"}]"}.json();
  };
  const std::string one = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"; // 36 bytes
  std::string escaped;
  for (const char c : Parts().bytes.substr(0, 36)) {
    constexpr const char* digits = "0123456789ABCDEF";
    escaped += {'%', digits[static_cast<unsigned char>(c) >> 4U],
                digits[static_cast<unsigned char>(c) & 15U]};
  }
  for (const std::string& uri :
       {"data:;base64," + one, "DATA:application/octet-stream;BASE64," + one,
        "data:application/gltf-buffer;base64," + one + "====",
        "data:;base64," + one.substr(0, 20) + "\\r\\n " + one.substr(20),
        "data:;base64," + one.substr(0, 20) + "%50" + one.substr(21), // 'P' as an escape
        "data:application/octet-stream," + escaped}) {
    const Result<PolygonMesh> mesh = test::read(with_uri(uri), MeshFormat::gltf);
    ASSERT_TRUE(mesh) << uri << ": " << mesh.error().message;
    EXPECT_EQ(mesh->positions[1], Vec3(1, 0, 0)) << uri;
  }
  EXPECT_EQ(test::message_of(with_uri("data:nothing"), MeshFormat::gltf),
            "file: buffer 0 is not valid base64; export the model again");
}

TEST(ReadGltf, ReadsContainersThatAreNotPadded) {
  const auto chunk = [](const std::string& type, const std::string& content, std::size_t padding) {
    return binary(static_cast<std::uint32_t>(content.size())) + type + content +
           std::string(padding, '\0');
  };
  std::string json = Parts().json();
  json.resize(json.size() + (5 - json.size() % 4) % 4, ' '); // one more than a multiple of four
  for (const std::string& mark : {std::string(), std::string("\xef\xbb\xbf")}) {
    for (const std::size_t padding : {0U, 3U}) { // three uncounted bytes
      const std::string text = mark.empty() ? json : mark + json + ' ';
      const std::string chunks = chunk("JSON", text, mark.empty() ? padding : 0) +
                                 chunk(std::string("BIN\0", 4), Parts().bytes, 0);
      const std::string glb =
          "glTF" + binary(2, static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
      EXPECT_EQ(test::message_of(glb, MeshFormat::gltf), "read") << mark.size() << ' ' << padding;
    }
  }
}

TEST(ReadGltf, NeedsOnlyTheBytesThatAreUsed) {
  Parts parts{.buffers = R"([{"byteLength":100}])"}; // of which there are 56
  EXPECT_EQ(message_of(parts), "read");
}

TEST(ReadGltf, SaysWhatOfTheFileIsLeftOut) {
  Parts parts{.scenes = R"([{"name":"day","nodes":[0]},{"name":"night","nodes":[]}])",
              .primitives = R"([{"attributes":{"POSITION":0}},{"mode":0,"attributes":)"
                            R"({"POSITION":0}},{"mode":1,"attributes":{"POSITION":0}}])"};
  const Result<ModelFile> file =
      ModelFile::parse(test::make_glb(parts.json(), parts.bytes), MeshFormat::gltf, "file");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->notes().size(), 2U);
  EXPECT_EQ(file->notes()[0].message,
            "file: mesh 0, primitive 1: draws points or lines, which are left out (and 1 more)");
  EXPECT_EQ(file->notes()[1].message, "file: scene 'day' is read; left out: scene 'night'");
  parts.more = R"(,"scene":1)";
  EXPECT_EQ(message_of(parts),
            "file: has no faces in its scene; make another the default one (scene 'day')");
}

TEST(ReadGltf, DoesNotLookForBuffersElsewhere) {
  for (const std::string uri : {"https://example.org/a.bin", "/etc/passwd", "a.bin"}) {
    const Parts parts{.buffers = R"([{"byteLength":36,"uri":")" + uri + "\"}]"};
    EXPECT_EQ(test::message_of(parts.json(), MeshFormat::gltf),
              "file: buffer 0 is kept at '" + uri +
                  "', which cannot be reached; save the model as GLB");
  }
}

TEST(ReadGltf, NamesTheCompressionItCannotUndo) {
  for (const std::string extension :
       {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"}) {
    EXPECT_NE(message_of({.more = R"(,"extensionsRequired":[")" + extension + "\"]"})
                  .find("needs the extension " + extension + ", which is not supported"),
              std::string::npos);
  }
  EXPECT_EQ(message_of({.primitives = R"([{"attributes":{"POSITION":0},"extensions":)"
                                      R"({"KHR_draco_mesh_compression":{}}}])",
                        .accessors = R"([{"componentType":5126,"count":3,"type":"VEC3"}])"}),
            "file: mesh 0, primitive 0 is compressed by the extension KHR_draco_mesh_compression, "
            "which is not supported; export the model without compression");
  EXPECT_EQ(message_of({.more = R"(,"extensionsRequired":["KHR_texture_basisu"])"}), "read");
}

struct BadGltf {
  Parts parts;
  std::string message;
};
void PrintTo(const BadGltf& bad, std::ostream* out) {
  *out << bad.message;
}

class ReadGltfRefuses : public testing::TestWithParam<BadGltf> {};

TEST_P(ReadGltfRefuses, WithTheObjectAndARemedy) {
  EXPECT_EQ(message_of(GetParam().parts), "file: " + GetParam().message);
}

const std::string beyond = " reaches beyond its buffer; export the model again";

INSTANTIATE_TEST_SUITE_P(
    Each, ReadGltfRefuses,
    testing::ValuesIn(std::vector<BadGltf>{
        {{.asset = R"({"version":"1.0"})"},
         "this is glTF version 1.0; export the model as glTF 2.0"},
        {{.asset = "3"}, "has no glTF version; check that this is a glTF file"},
        {{.more = R"(,"scene":1)"}, "the default scene does not exist; export the model again"},
        {{.scenes = R"([{"nodes":[1]}])"},
         "scene 0 refers to a node that does not exist; export the model again"},
        {{.nodes = R"([{"mesh":0,"children":[0]}])"},
         "node 0 stands in the scene twice; export the model again"},
        {{.nodes = R"([{"mesh":7}])"},
         "node 0 refers to a mesh that does not exist; export the model again"},
        {{.nodes = R"([{"mesh":-1}])"},
         "node 0 refers to a mesh that does not exist; export the model again"},
        {{.nodes = R"([{"mesh":0,"scale":[1,1]}])"},
         "node 0 has a transform that is not one; export the model again"},
        {{.nodes = R"([{"mesh":0,"translation":[1,1,"1"]}])"},
         "node 0 has a transform that is not one; export the model again"},
        {{.nodes = R"([{"mesh":0,"scale":[1e300,1,1],"children":[]}])",
          .bytes = binary(1e30F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F) + std::string(20, '\0')},
         "accessor 0: vertex 0 has a coordinate that is not a finite number; export the "
         "model again"},
        {{.bytes = binary(0.F, std::numeric_limits<float>::quiet_NaN(), 0.F) +
                   std::string(44, '\0')},
         "accessor 0: vertex 0 has a coordinate that is not a finite number; export the "
         "model again"},
        {{.accessors = R"([{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}])"},
         "accessor 0 with 4 elements" + beyond},
        {{.accessors =
              R"([{"bufferView":0,"componentType":5126,"count":9007199254740992,"type":"VEC3"}])"},
         "accessor 0 with 9007199254740992 elements" + beyond},
        {{.accessors = R"([{"componentType":5126,"count":9007199254740992,"type":"VEC3"}])"},
         "accessor 0 promises 9007199254740992 elements but stores none; export the model "
         "again"},
        {{.accessors = R"([{"bufferView":0,"componentType":5126,"count":1e300,"type":"VEC3"}])"},
         "accessor 0 has no count or no known component type; export the model again"},
        {{.accessors = R"([{"bufferView":0,"componentType":5124,"count":3,"type":"VEC3"}])"},
         "accessor 0 has no count or no known component type; export the model again"},
        {{.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}])"},
         "accessor 0 should have 3 numbers for each element; export the model again"},
        {{.accessors = "[]"},
         "accessor 0 has no count or no known component type; export the model again"},
        {{.views = R"([{"buffer":0,"byteLength":36,"byteStride":2}])"},
         "accessor 0 with 3 elements" + beyond},
        {{.views = R"([{"buffer":0,"byteLength":36,"byteOffset":9007199254740992}])"},
         "accessor 0 with 3 elements" + beyond},
        {{.views = R"([{"buffer":1,"byteLength":36}])"},
         "buffer 1 does not exist; export the model again"},
        {{.views = "{}"},
         "accessor 0 refers to a buffer view that does not exist; export the model again"},
        {{.accessors = R"([{"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"}])",
          .views = R"([{"buffer":0,"byteLength":60}])",
          .buffers = R"([{"byteLength":100}])"},
         "buffer 0 should have 100 bytes, but has 56; export the model again"},
        {{.buffers = R"([{"byteLength":36,"uri":"data:;base64,AA!A"}])"},
         "buffer 0 is not valid base64; export the model again"},
        {with_indices("5125", binary(0, 1, 4), 3),
         "mesh 0, primitive 0 refers to vertex 4, but there are 4; export the model again"},
        {with_indices("5125", binary(0, 1, -1), 3),
         "mesh 0, primitive 0 refers to vertex 4294967295, but there are 4; export the "
         "model again"},
        {with_indices("5126", binary(0, 1, 2), 3),
         "accessor 1 holds indices of a type that glTF does not allow; export the model "
         "again"},
        {with_indices("5125", binary(0, 1, 2), 3, 7),
         "mesh 0, primitive 0 has a mode that glTF does not know; export the model again"}}));

TEST(ReadGltf, RefusesWhatIsNoJson) {
  const auto message = [](std::string_view text) {
    return test::message_of(text, MeshFormat::gltf);
  };
  EXPECT_EQ(message(R"({"asset":})"),
            "file: byte 9: the JSON is not valid here; export the model again");
  EXPECT_EQ(message("[]"), "file: byte 0: the JSON is no object; export the model again");
  EXPECT_EQ(message(R"({"asset":1e999})"),
            "file: the JSON holds a number that is too large; export the model again");
  EXPECT_EQ(message(std::string(1 << 20, '[')),
            "file: the JSON is nested too deeply for glTF; export the model again");
  EXPECT_EQ(message("{\"a\":\"\xff\"}").substr(0, 14), "file: byte 6: ");
}

TEST(ReadGltf, RefusesContainersThatAreCutShort) {
  const std::string glb = test::make_glb(Parts().json(), Parts().bytes);
  EXPECT_NE(test::message_of(glb.substr(0, glb.size() - 1), MeshFormat::gltf).find("is cut short"),
            std::string::npos);
  EXPECT_EQ(test::message_of("glTF" + binary(1, 20, 0, 0), MeshFormat::gltf),
            "file: byte 4: this is GLB version 1; export the model as glTF 2.0");
  EXPECT_EQ(test::message_of("glTF" + binary(2, 20, 0xffffffffU) + "JSON", MeshFormat::gltf),
            "file: byte 12: a chunk of 4294967295 bytes reaches beyond the end of the file; it is "
            "cut short; export the model again");
}

TEST(ReadGltf, RefusesInstancesWithoutEnd) {
  // A thousand primitives over the same million triangles, from a file of three megabytes.
  std::string primitives(1, '[');
  for (int i = 0; i < 1000; ++i) {
    primitives += R"({"attributes":{"POSITION":0},"indices":1},)";
  }
  primitives += R"({"attributes":{"POSITION":0}}])";
  Parts parts{.primitives = primitives};
  parts.accessors = R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
                    R"({"bufferView":1,"componentType":5121,"count":3000000,"type":"SCALAR"}])";
  parts.views =
      R"([{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":3000000}])";
  parts.buffers = R"([{"byteLength":3000036}])";
  parts.bytes.resize(36);
  parts.bytes.resize(3000036, '\0');
  EXPECT_EQ(message_of(parts), "file: shows more than 22 million triangles; simplify the model");
}

} // namespace
} // namespace cagewright
