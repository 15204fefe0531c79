#include "deform/npz.h"

#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <concepts>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

// The zip format is PKWARE's APPNOTE 6.3, with its 64-bit extension where a size needs it; the
// arrays are NumPy's NPY format, version 1.0.

namespace cagewright {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they are");

constexpr std::uint32_t local_signature = 0x04034b50;
constexpr std::uint32_t central_signature = 0x02014b50;
constexpr std::uint32_t end_signature = 0x06054b50;
constexpr std::uint32_t end64_signature = 0x06064b50;
constexpr std::uint32_t locator64_signature = 0x07064b50;
constexpr std::uint32_t max32 = 0xffffffff;
constexpr std::uint16_t stored = 0;
constexpr std::uint16_t deflated = 8;
constexpr std::uint16_t epoch_date = 0x21; // 1980-01-01: the same weights give the same bytes

/// Appends numbers byte by byte.
class Record {
public:
  template <std::integral T> Record& add(T value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    text_.append(bytes.data(), bytes.size());
    return *this;
  }
  Record& add(std::string_view text) {
    text_.append(text);
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

private:
  std::string text_;
};

/// Takes numbers from bytes; zero beyond their end.
class Fields {
public:
  explicit Fields(std::string_view bytes) : bytes_(bytes) {}

  template <class T> T take() {
    std::array<char, sizeof(T)> raw{};
    if (bytes_.size() >= sizeof(T)) {
      std::copy_n(bytes_.begin(), sizeof(T), raw.begin());
    }
    skip(sizeof(T));
    return std::bit_cast<T>(raw);
  }
  std::string_view take_text(std::size_t size) {
    const std::string_view text = bytes_.substr(0, size);
    skip(size);
    return text;
  }
  void skip(std::size_t size) {
    if (size > bytes_.size()) {
      overrun_ = true;
      size = bytes_.size();
    }
    bytes_.remove_prefix(size);
  }
  [[nodiscard]] bool overrun() const { return overrun_; }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }

private:
  std::string_view bytes_;
  bool overrun_ = false;
};

std::uint32_t clipped(std::uint64_t value) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, max32));
}

std::string npy_prologue(const NpyHeader& header) {
  std::string shape;
  for (const std::uint64_t n : header.shape) {
    shape += std::to_string(n) + (header.shape.size() == 1 ? "," : ", ");
  }
  if (header.shape.size() > 1) {
    shape.resize(shape.size() - 2);
  }
  std::string text =
      "{'descr': '" + header.type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  text.append(63 - (text.size() + 10) % 64, ' '); // the data begin at a multiple of 64
  text += '\n';
  return Record()
      .add(std::string_view("\x93NUMPY\x01\0", 8))
      .add(static_cast<std::uint16_t>(text.size()))
      .add(text)
      .text();
}

std::string_view value_after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  return at == std::string_view::npos ? std::string_view() : text.substr(at + key.size());
}

/// Parses the dictionary of an array. \returns false when it is not of our kind.
bool parse_npy(std::string_view text, NpyHeader& header) {
  std::string_view type = value_after(text, "'descr': '");
  if (value_after(text, "'fortran_order': ").substr(0, 5) != "False" || type.empty()) {
    return false;
  }
  header.type = type.substr(0, type.find('\''));
  std::string_view shape = value_after(text, "'shape': (");
  if (shape.find(')') == std::string_view::npos) {
    return false;
  }
  shape = shape.substr(0, shape.find(')'));
  while (!shape.empty()) {
    std::uint64_t n = 0;
    const auto [end, error] = std::from_chars(shape.data(), shape.data() + shape.size(), n);
    if (error != std::errc()) {
      return false;
    }
    header.shape.push_back(n);
    shape.remove_prefix(static_cast<std::size_t>(end - shape.data()));
    shape.remove_prefix(std::min(shape.find_first_not_of(", "), shape.size()));
  }
  return header.shape.size() <= 4;
}

std::string read_at(std::FILE* file, std::uint64_t offset, std::size_t size) {
  std::string bytes(size, '\0');
  if (!seek_to(file, offset)) {
    return {};
  }
  bytes.resize(std::fread(bytes.data(), 1, size, file));
  return bytes;
}

} // namespace

std::uint64_t NpyHeader::count() const {
  std::uint64_t product = 1;
  for (const std::uint64_t n : shape) {
    if (n != 0 && product > std::numeric_limits<std::uint64_t>::max() / n) {
      return std::numeric_limits<std::uint64_t>::max(); // more than any file holds
    }
    product *= n;
  }
  return product;
}

Result<NpzWriter> NpzWriter::create(const std::filesystem::path& path) {
  Result<PartFile> file = PartFile::create(path);
  return file ? Result<NpzWriter>(NpzWriter(*std::move(file))) : file.error();
}

Status NpzWriter::put(std::string_view bytes) {
  offset_ += bytes.size();
  return file_.append(bytes);
}

Status NpzWriter::begin(std::string_view name, const NpyHeader& header, std::size_t item_size) {
  const std::string prologue = npy_prologue(header);
  Entry entry{std::string(name) + ".npy", offset_, prologue.size() + header.count() * item_size, 0};
  const bool is_large = entry.size >= max32;
  Record local;
  local.add(local_signature)
      .add(std::uint16_t(is_large ? 45 : 20))
      .add(std::uint16_t(0))
      .add(stored)
      .add(std::uint16_t(0))
      .add(epoch_date)
      .add(std::uint32_t(0)) // the checksum: end() puts it here
      .add(clipped(entry.size))
      .add(clipped(entry.size))
      .add(static_cast<std::uint16_t>(entry.name.size()))
      .add(std::uint16_t(is_large ? 20 : 0))
      .add(entry.name);
  if (is_large) {
    local.add(std::uint16_t(1)).add(std::uint16_t(16)).add(entry.size).add(entry.size);
  }
  entries_.push_back(std::move(entry));
  if (Status s = put(local.text()); !s) {
    return s;
  }
  return write(std::as_bytes(std::span(prologue)));
}

Status NpzWriter::write(std::span<const std::byte> bytes) {
  Entry& entry = entries_.back();
  entry.crc = static_cast<std::uint32_t>(
      crc32_z(entry.crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  return put({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Status NpzWriter::end() {
  const Entry& entry = entries_.back();
  const std::string crc = Record().add(entry.crc).text();
  return file_.overwrite(entry.offset + 14, crc);
}

Status NpzWriter::finish() {
  const std::uint64_t directory = offset_;
  Record central;
  for (const Entry& entry : entries_) {
    const bool is_large = entry.size >= max32 || entry.offset >= max32;
    central.add(central_signature)
        .add(std::uint16_t(is_large ? 45 : 20))
        .add(std::uint16_t(is_large ? 45 : 20))
        .add(std::uint16_t(0))
        .add(stored)
        .add(std::uint16_t(0))
        .add(epoch_date)
        .add(entry.crc)
        .add(is_large ? max32 : clipped(entry.size))
        .add(is_large ? max32 : clipped(entry.size))
        .add(static_cast<std::uint16_t>(entry.name.size()))
        .add(std::uint16_t(is_large ? 28 : 0))
        .add(std::uint16_t(0))
        .add(std::uint16_t(0))
        .add(std::uint16_t(0))
        .add(std::uint32_t(0))
        .add(is_large ? max32 : clipped(entry.offset))
        .add(entry.name);
    if (is_large) {
      central.add(std::uint16_t(1)).add(std::uint16_t(24));
      central.add(entry.size).add(entry.size).add(entry.offset);
    }
  }
  const std::uint64_t size = central.text().size();
  const std::uint64_t count = entries_.size();
  if (directory >= max32) {
    central.add(end64_signature)
        .add(std::uint64_t(44))
        .add(std::uint16_t(45))
        .add(std::uint16_t(45))
        .add(std::uint32_t(0))
        .add(std::uint32_t(0))
        .add(count)
        .add(count)
        .add(size)
        .add(directory);
    central.add(locator64_signature)
        .add(std::uint32_t(0))
        .add(directory + size)
        .add(std::uint32_t(1));
  }
  central.add(end_signature)
      .add(std::uint16_t(0))
      .add(std::uint16_t(0))
      .add(static_cast<std::uint16_t>(count))
      .add(static_cast<std::uint16_t>(count))
      .add(clipped(size))
      .add(clipped(directory))
      .add(std::uint16_t(0));
  if (Status s = put(central.text()); !s) {
    return s;
  }
  return file_.commit();
}

struct NpzReader::Array::Inflater {
  z_stream stream{};
  std::array<Bytef, 1U << 16U> input;

  Inflater() { inflateInit2(&stream, -MAX_WBITS); }
  ~Inflater() { inflateEnd(&stream); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

NpzReader::Array::Array() = default;
NpzReader::Array::~Array() = default;
NpzReader::Array::Array(Array&&) noexcept = default;

Error NpzReader::Array::damaged(std::string_view how) const {
  return {ErrorCode::malformed, label_ + " is damaged: " + std::string(how)};
}

Status NpzReader::Array::read(std::span<std::byte> bytes) {
  if (bytes.size() > remaining_) {
    return damaged("it ends too early");
  }
  auto* const to = reinterpret_cast<Bytef*>(bytes.data());
  if (!inflater_) {
    if (std::fread(to, 1, bytes.size(), file_) != bytes.size()) {
      return damaged("the file ends too early");
    }
  } else {
    z_stream& stream = inflater_->stream;
    std::size_t done = 0;
    while (done < bytes.size()) {
      if (stream.avail_in == 0) {
        const std::size_t wanted = std::min<std::uint64_t>(inflater_->input.size(), compressed_);
        stream.next_in = inflater_->input.data();
        stream.avail_in = static_cast<uInt>(std::fread(inflater_->input.data(), 1, wanted, file_));
        compressed_ -= stream.avail_in;
        if (stream.avail_in == 0) {
          return damaged("its compressed data end too early");
        }
      }
      stream.next_out = to + done;
      stream.avail_out = static_cast<uInt>(std::min<std::size_t>(bytes.size() - done, 1U << 30U));
      const uInt room = stream.avail_out;
      const int state = inflate(&stream, Z_NO_FLUSH);
      done += room - stream.avail_out;
      if (state != Z_OK && !(state == Z_STREAM_END && done == bytes.size())) {
        return damaged("its compressed data make no sense");
      }
    }
  }
  crc_ = static_cast<std::uint32_t>(crc32_z(crc_, to, bytes.size()));
  remaining_ -= bytes.size();
  if (remaining_ == 0 && crc_ != expected_crc_) {
    return damaged("its checksum differs");
  }
  return success();
}

Result<NpzReader> NpzReader::open(const std::filesystem::path& path) {
  NpzReader reader;
  reader.label_ = path.string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    return Error{ErrorCode::cannot_open,
                 reader.label_ + ": " + (error ? error.message() : "not a regular file")};
  }
  reader.file_ = open_regular_file(path, reader.file_size_);
  if (!reader.file_) {
    return Error{ErrorCode::cannot_open, reader.label_ + ": " + std::strerror(errno)};
  }
  if (Status s = reader.read_directory(); !s) {
    return s.error();
  }
  return reader;
}

Status NpzReader::read_directory() {
  const auto malformed = [&](const char* what) {
    return Error{ErrorCode::malformed, label_ + ": " + what};
  };
  const std::uint64_t tail_size = std::min<std::uint64_t>(file_size_, 65557);
  const std::string tail = read_at(file_.get(), file_size_ - tail_size, tail_size);
  const std::size_t at = tail.rfind(Record().add(end_signature).text());
  if (at == std::string::npos) {
    return malformed("not a .npz file, or cut off: it does not end with a zip directory");
  }
  Fields end(std::string_view(tail).substr(std::min(at + 10, tail.size())));
  std::uint64_t count = end.take<std::uint16_t>();
  std::uint64_t size = end.take<std::uint32_t>();
  std::uint64_t offset = end.take<std::uint32_t>();
  if (offset == max32 && at >= 20) {
    Fields locator(std::string_view(tail).substr(at - 20));
    if (locator.take<std::uint32_t>() == locator64_signature) {
      locator.skip(4);
      const std::string end64 = read_at(file_.get(), locator.take<std::uint64_t>(), 56);
      Fields fields(std::string_view(end64).substr(std::min<std::size_t>(32, end64.size())));
      count = fields.take<std::uint64_t>();
      size = fields.take<std::uint64_t>();
      offset = fields.take<std::uint64_t>();
    }
  }
  if (size > file_size_ || offset > file_size_ - size || count > 1000) {
    return malformed("damaged: its zip directory lies outside the file");
  }
  const std::string directory = read_at(file_.get(), offset, size);
  Fields fields(directory);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (fields.take<std::uint32_t>() != central_signature) {
      return malformed("damaged: its zip directory makes no sense");
    }
    Entry entry;
    fields.skip(6);
    entry.method = fields.take<std::uint16_t>();
    fields.skip(4);
    entry.crc = fields.take<std::uint32_t>();
    entry.compressed = fields.take<std::uint32_t>();
    entry.size = fields.take<std::uint32_t>();
    const auto name_size = fields.take<std::uint16_t>();
    const auto extra_size = fields.take<std::uint16_t>();
    const auto comment_size = fields.take<std::uint16_t>();
    fields.skip(8);
    entry.offset = fields.take<std::uint32_t>();
    const std::string name(fields.take_text(name_size));
    Fields extra(fields.take_text(extra_size));
    while (!extra.empty() && !extra.overrun()) {
      const auto id = extra.take<std::uint16_t>();
      const auto length = extra.take<std::uint16_t>();
      Fields large(extra.take_text(length));
      if (id == 1) {
        for (std::uint64_t* value : {&entry.size, &entry.compressed, &entry.offset}) {
          if (*value == max32) {
            *value = large.take<std::uint64_t>();
          }
        }
      }
    }
    fields.skip(comment_size);
    if (fields.overrun() || entry.offset > file_size_ || entry.compressed > file_size_) {
      return malformed("damaged: its zip directory makes no sense");
    }
    entries_[name] = entry;
  }
  return success();
}

bool NpzReader::has(std::string_view name) const {
  return entries_.contains(std::string(name) + ".npy");
}

Error NpzReader::unexpected(std::string_view name, const NpyHeader& header) const {
  std::string shape;
  for (const std::uint64_t n : header.shape) {
    shape += (shape.empty() ? "" : " x ") + std::to_string(n);
  }
  return {ErrorCode::malformed,
          label_ + ": array '" + std::string(name) + "' is not as expected (" +
              (shape.empty() ? "one value" : shape) + " of type " + header.type + ")"};
}

Result<NpzReader::Array> NpzReader::array(std::string_view name) {
  Array array;
  array.label_ = label_ + ": array '" + std::string(name) + "'";
  const auto found = entries_.find(std::string(name) + ".npy");
  if (found == entries_.end()) {
    return Error{ErrorCode::malformed, label_ + ": it has no array '" + std::string(name) + "'"};
  }
  const Entry& entry = found->second;
  const std::string local = read_at(file_.get(), entry.offset, 30);
  Fields fields(local);
  if (fields.take<std::uint32_t>() != local_signature) {
    return array.damaged("it is not where the zip directory says");
  }
  fields.skip(22);
  const std::uint64_t skip =
      fields.take<std::uint16_t>() + std::uint64_t(fields.take<std::uint16_t>());
  if (entry.method == deflated) {
    array.inflater_ = std::make_unique<Array::Inflater>();
  } else if (entry.method != stored || entry.size != entry.compressed) {
    return array.damaged("it is compressed in a way that is not known");
  }
  array.file_ = file_.get();
  array.remaining_ = entry.size;
  array.compressed_ = entry.compressed;
  array.expected_crc_ = entry.crc;
  seek_to(file_.get(), entry.offset + 30 + skip);

  std::array<char, 10> magic{};
  if (Status s = array.read(std::as_writable_bytes(std::span(magic))); !s) {
    return s.error();
  }
  if (std::string_view(magic.data(), 7) != std::string_view("\x93NUMPY\x01", 7)) {
    return array.damaged("it does not begin as an array of NumPy does");
  }
  std::string text(static_cast<unsigned char>(magic[8]) |
                       (static_cast<std::size_t>(static_cast<unsigned char>(magic[9])) << 8U),
                   '\0');
  if (Status s = array.read(std::as_writable_bytes(std::span(text))); !s) {
    return s.error();
  }
  if (!parse_npy(text, array.header_)) {
    return array.damaged("its header makes no sense");
  }
  return array;
}

} // namespace cagewright
