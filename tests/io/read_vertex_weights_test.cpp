#include <cagewright/io/read_vertex_weights.h>

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace cagewright {
namespace {

Result<std::vector<double>> read(const std::string& bytes, std::size_t count) {
  return read_vertex_weights(bytes, "weights", count);
}

/// A .npy file of version 1.0, as NumPy writes it.
template <class T>
std::string npy(const std::string& type, const std::string& shape, const std::vector<T>& values) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize(118 - 1, ' ');
  header += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += '\1';
  bytes += '\0';
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  bytes += header;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return bytes;
}

TEST(ReadVertexWeights, ReadsOneNumberALine) {
  const auto weights = read("# painted\n1\n\n 2.5e0  # twice\n0\r\n+4", 4);
  ASSERT_TRUE(weights) << weights.error().message;
  EXPECT_EQ(*weights, (std::vector<double>{1, 2.5, 0, 4}));
}

TEST(ReadVertexWeights, ReadsArraysOfNumPy) {
  const std::vector<double> expected = {1, 2, 3};
  EXPECT_EQ(*read(npy<double>("<f8", "(3,)", {1, 2, 3}), 3), expected);
  EXPECT_EQ(*read(npy<float>("<f4", "(3, 1)", {1, 2, 3}), 3), expected);
  EXPECT_EQ(*read(npy<std::int64_t>("<i8", "(3,)", {1, 2, 3}), 3), expected);
  EXPECT_EQ(*read(npy<std::uint8_t>("|u1", "(3,)", {1, 2, 3}), 3), expected);
}

TEST(ReadVertexWeights, NamesTheLineOfWhatIsNoWeight) {
  for (const char* bad : {"-1", "nan", "inf", "x", "1e999", "3 4"}) {
    const auto weights = read("1\n2\n" + std::string(bad) + "\n", 3);
    ASSERT_FALSE(weights) << bad;
    EXPECT_EQ(weights.error().code, ErrorCode::malformed) << bad;
    EXPECT_NE(weights.error().message.find("weights:3:"), std::string::npos)
        << weights.error().message;
  }
}

TEST(ReadVertexWeights, NamesTheIndexOfWhatIsNoWeight) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, -2.0, std::numeric_limits<double>::infinity()}) {
    const auto weights = read(npy<double>("<f8", "(3,)", {1, bad, 3}), 3);
    ASSERT_FALSE(weights);
    EXPECT_NE(weights.error().message.find("number 1 "), std::string::npos)
        << weights.error().message;
  }
}

TEST(ReadVertexWeights, RefusesAnotherNumberOfThem) {
  for (const std::string& bytes :
       {std::string("1\n2\n"), std::string("1\n2\n3\n4\n"), std::string(),
        npy<double>("<f8", "(2,)", {1, 2}), npy<double>("<f8", "(4,)", {1, 2, 3, 4})}) {
    const auto weights = read(bytes, 3);
    ASSERT_FALSE(weights);
    EXPECT_EQ(weights.error().code, ErrorCode::mismatch) << weights.error().message;
  }
}

TEST(ReadVertexWeights, RefusesArraysOfAnotherKind) {
  EXPECT_FALSE(read(npy<double>(">f8", "(3,)", {1, 2, 3}), 3));
  EXPECT_FALSE(read(npy<double>("<c16", "(3,)", {1, 2, 3}), 3));
  EXPECT_FALSE(read(npy<double>("<f8", "(3, 2)", {1, 2, 3, 4, 5, 6}), 3));
  EXPECT_FALSE(read(npy<double>("<f8", "()", {1}), 1));
}

TEST(ReadVertexWeights, SurvivesAnyTruncation) {
  const std::string whole = npy<double>("<f8", "(3,)", {1, 2, 3});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(read(whole.substr(0, length), 3)) << length;
  }
}

TEST(ReadVertexWeights, RefusesFilesThatAreNotThere) {
  const auto weights = read_vertex_weights("/nowhere/weights.txt", 3);
  ASSERT_FALSE(weights);
  EXPECT_EQ(weights.error().code, ErrorCode::cannot_open);
}

} // namespace
} // namespace cagewright
