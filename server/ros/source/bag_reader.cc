#include "server/ros/source/bag_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "server/ros/source/bag_record.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";
constexpr std::string_view kAnyBagMagic = "#ROSBAG V";

constexpr std::uint32_t kLargestHeader = 1 << 16;       // bytes; rosbag writes about 50
constexpr std::uint32_t kLargestConnection = 4 << 20;   // with the text of the message definition
constexpr std::size_t kMostConnectionBytes = 16 << 20;  // of all names that are kept
constexpr std::uint64_t kSeekFrom = 256 * 1024;         // bytes; fewer are read faster than sought
constexpr std::size_t kPackedBlock = 64 * 1024;
constexpr std::size_t kLargestKept = 8 << 20;  // bytes; rosbag makes chunks of 768 kB

constexpr char kBeyondChunk[] = "record that extends beyond its chunk";
constexpr char kBadHeader[] = "record with a damaged header";
constexpr char kBadConnection[] = "connection record that is damaged or too long";
constexpr char kManyConnections[] = "connection beyond the limit";
constexpr char kUnknownConnection[] = "message of a connection that the bag does not describe";
constexpr char kNotUnpacked[] = "chunk that cannot be decompressed";
constexpr char kBadChecksum[] =
    "chunk that fails its checksum or cannot be decompressed, with all of its messages";
constexpr char kUsedBefore[] = "chunk that fails its checksum after its messages were used";
constexpr char kBadChunkLength[] = "chunk with a damaged length";
constexpr char kCutOff[] = "record that is cut off by the end of the bag";
constexpr char kBadIndex[] = "index with a damaged length";

constexpr std::string_view kChunkSign = "compression=";  // in the header of every chunk
constexpr std::size_t kBeforeSign = 64;                  // bytes of a header, at most

SourceError NotABag(const std::string& path, const std::string& what) {
  return SourceError("bag '" + path + "': " + what);
}

}  // namespace

InputFile OpenBagFile(const std::string& path) {
  InputFile file = OpenInputFile(path);
  if (!StartsWith(file.head(), kBagMagic)) {
    if (!file.head().empty() && StartsWith(kBagMagic, file.head())) {
      throw NotABag(path, "truncated within its first line; copy it again from its origin");
    }
    if (StartsWith(file.head(), kAnyBagMagic)) {
      throw NotABag(path,
                    "unsupported version of the bag format; expected 2.0: convert it with `rosbag "
                    "filter old.bag new.bag True`");
    }
    throw NotABag(path, "not a ROS 1 bag; convert a ROS 2 bag with rosbags-convert");
  }
  if (file.is_packed()) return file;
  std::FILE* const plain = std::fopen(path.c_str(), "rbe");
  if (plain == nullptr) return file;  // just deleted
  return {plain};
}

BagReader::BagReader(InputFile file, IsWanted is_wanted)
    : file_(std::move(file)), is_wanted_(std::move(is_wanted)), packed_(kPackedBlock) {
  struct stat about {};
  can_seek_ = !file_.is_packed() && fileno(file_.get()) >= 0 &&
              fstat(fileno(file_.get()), &about) == 0 && S_ISREG(about.st_mode);
  if (can_seek_) file_size_ = static_cast<std::uint64_t>(about.st_size);
  std::array<char, kBagMagic.size()> magic{};
  if (ReadFile(magic.data(), magic.size()) &&
      std::string_view(magic.data(), magic.size()) != kBagMagic) {
    End(Ending::Kind::kDamaged, "it does not begin as a bag");
  }
}

bool BagReader::Next(BagMessage& message) {
  while (!has_ended_) {
    if (ReadRecord(message)) return true;
  }
  return false;
}

void BagReader::End(Ending::Kind kind, std::string reason) {
  if (std::exchange(has_ended_, true)) return;
  ending_ = {kind, std::move(reason)};
}

void BagReader::LoseFraming(const char* reason) {
  Count(reason);
  if (chunk_ && !chunk_->has_two_lengths) return CloseChunk();
  chunk_.reset();
  if (index_at_ > 0 && at_ >= index_at_) return End(Ending::Kind::kClosed);  // nothing else follows
  if (!FindChunk()) End(Ending::Kind::kDamaged, reason);
}

bool BagReader::FindChunk() {
  std::string text;
  for (bool is_at_end = false; !is_at_end;) {
    text.erase(0, text.size() - std::min(text.size(), kBeforeSign + kLongestChunkHeader));
    const std::size_t old = text.size();
    text.resize(old + kPackedBlock);
    text.resize(old + Take(text.data() + old, kPackedBlock));
    is_at_end = text.size() < old + kPackedBlock;
    for (std::size_t sign = text.find(kChunkSign); sign != std::string::npos;
         sign = text.find(kChunkSign, sign + 1)) {
      for (std::size_t before = 0; before <= std::min(sign, kBeforeSign); ++before) {
        if (!BeginsBagChunk(std::string_view(text).substr(sign - before))) continue;
        at_ -= text.size() - (sign - before);
        ahead_ = text.substr(sign - before) + ahead_.substr(ahead_read_);
        ahead_read_ = 0;
        return true;
      }
    }
  }
  return false;
}

std::size_t BagReader::Take(void* to, std::size_t size) {
  std::size_t count = ahead_.copy(static_cast<char*>(to), size, ahead_read_);
  ahead_read_ += count;
  if (count < size) {
    count += std::fread(static_cast<char*>(to) + count, 1, size - count, file_.get());
  }
  at_ += count;
  return count;
}

bool BagReader::ReadFile(void* to, std::size_t size) {
  if (Take(to, size) == size) return true;
  EndOfFile();
  return false;
}

void BagReader::EndOfFile() {
  if (std::ferror(file_.get()) != 0) return End(Ending::Kind::kUnreadable, file_.failure());
  Count(kCutOff);
  End(Ending::Kind::kTruncated);
}

bool BagReader::SkipInFile(std::uint64_t size) {
  if (can_seek_ && ahead_read_ == ahead_.size() && size > kSeekFrom) {
    if (size > file_size_ - std::min(at_, file_size_)) {
      EndOfFile();
      return false;
    }
    if (fseeko(file_.get(), static_cast<off_t>(size), SEEK_CUR) == 0) {
      at_ += size;
      return true;
    }
  }
  std::array<char, 16 * 1024> unused;
  while (size > 0) {
    const std::size_t part = std::min<std::uint64_t>(size, unused.size());
    if (!ReadFile(unused.data(), part)) return false;
    size -= part;
  }
  return true;
}

bool BagReader::Read(void* to, std::size_t size) {
  if (!chunk_) return ReadFile(to, size);
  if (size > chunk_->left) {
    LoseFraming(kBeyondChunk);
    return false;
  }
  if (chunk_->is_checked) return ReadChecked(to, size);
  chunk_->left -= size;
  if (chunk_->unpacker != nullptr) return ReadUnpacked(static_cast<char*>(to), size);
  chunk_->left_in_file -= size;
  return ReadFile(to, size);
}

bool BagReader::ReadChecked(void* to, std::size_t size) {
  if (size > unpacked_.size() - unpacked_read_) {
    EndOfFile();
    return false;
  }
  std::memcpy(to, unpacked_.data() + unpacked_read_, size);
  unpacked_read_ += size;
  chunk_->left -= size;
  return true;
}

bool BagReader::ReadUnpacked(char* to, std::size_t size) {
  while (size > 0) {
    const ssize_t count = chunk_->unpacker->Read(to, size);
    if (count <= 0) {
      // The file may end inside the chunk, or the chunk inside a record.
      if (EndsInChunk()) {
        EndOfFile();
      } else {
        LoseFraming(kNotUnpacked);
      }
      return false;
    }
    to += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

ssize_t BagReader::ReadPacked(const void** bytes) {
  const std::size_t most = std::min<std::uint64_t>(packed_.size(), chunk_->left_in_file);
  const std::size_t count = Take(packed_.data(), most);
  chunk_->left_in_file -= count;
  *bytes = packed_.data();
  return static_cast<ssize_t>(count);
}

bool BagReader::Skip(std::uint64_t size) {
  if (!chunk_) return SkipInFile(size);
  if (size > chunk_->left) {
    LoseFraming(kBeyondChunk);
    return false;
  }
  if (chunk_->unpacker == nullptr) {
    chunk_->left -= size;
    chunk_->left_in_file -= size;
    return SkipInFile(size);
  }
  std::array<char, 16 * 1024> unused;
  while (size > 0) {
    const std::size_t part = std::min<std::uint64_t>(size, unused.size());
    if (!Read(unused.data(), part)) return false;
    size -= part;
  }
  return true;
}

bool BagReader::IsAtEnd() {
  if (ahead_read_ < ahead_.size()) return false;
  const int next = std::fgetc(file_.get());
  if (next == EOF) return true;
  std::ungetc(next, file_.get());
  return false;
}

bool BagReader::ReadRecord(BagMessage& message) {
  if (chunk_ && chunk_->left == 0) CloseChunk();
  if (!chunk_ && !has_ended_ && IsAtEnd()) {
    if (std::ferror(file_.get()) != 0) {
      EndOfFile();
    } else {
      const bool is_closed = index_at_ > 0 && at_ >= index_at_;
      End(is_closed ? Ending::Kind::kClosed : Ending::Kind::kTruncated);
    }
  }
  std::uint32_t size = 0;
  if (has_ended_ || !Read(&size, sizeof(size))) return false;
  if (size == 0 || size > kLargestHeader) {
    LoseFraming(kBadHeader);
    return false;
  }
  bytes_.resize(size);
  if (!Read(bytes_.data(), size) || !Read(&size, sizeof(size))) return false;
  BagRecordHeader header;
  if (!header.Parse(bytes_)) {
    if (chunk_) {
      Count(kBadHeader);
      Skip(size);
    } else {
      LoseFraming(kBadHeader);
    }
    return false;
  }
  if (!header.Fits(size)) {
    LoseFraming(kBadIndex);
    return false;
  }
  switch (header.op) {
    case BagOp::kMessage: return ReadMessage(header, size, message);
    case BagOp::kConnection: ReadConnection(header, size); return false;
    case BagOp::kChunk: OpenChunk(header, size); return false;
    case BagOp::kBagHeader:
      index_at_ = header.index_at.value_or(0);
      if (header.is_encrypted) End(Ending::Kind::kEncrypted);
      break;
    default: break;  // indices, which a reader from front to back does not need
  }
  Skip(size);
  return false;
}

bool BagReader::ReadMessage(const BagRecordHeader& header, std::uint32_t size,
                            BagMessage& message) {
  if (!header.connection || !header.time) {
    Count(kBadHeader);
    Skip(size);
    return false;
  }
  auto connection = connections_.find(*header.connection);
  if (connection == connections_.end()) {
    ReadConnectionsOfIndex();
    connection = connections_.find(*header.connection);
  }
  if (connection == connections_.end()) {
    Count(kUnknownConnection);
    Skip(size);
    return false;
  }
  const auto seconds = static_cast<std::uint32_t>(*header.time);
  const auto nanos = static_cast<std::uint32_t>(*header.time >> 32U);
  message.connection = &connection->second;
  message.recorded_nanos = std::int64_t{seconds} * kNanosPerSecond + nanos;
  message.size = size;
  message.bytes.clear();
  if (size > kLargestMessage || !is_wanted_(connection->second)) return Skip(size);
  if (chunk_ && size > chunk_->left) {
    LoseFraming(kBeyondChunk);
    return false;
  }
  message.bytes.resize(size);
  return Read(message.bytes.data(), size);
}

void BagReader::ReadConnection(const BagRecordHeader& header, std::uint32_t size) {
  const bool is_known = header.connection && connections_.count(*header.connection) > 0;
  if (is_known) return static_cast<void>(Skip(size));  // closed bags repeat all of them at the end
  if (!header.connection || header.topic.empty() || size > kLargestConnection) {
    Count(kBadConnection);
    return static_cast<void>(Skip(size));
  }
  if (chunk_ && size > chunk_->left) return LoseFraming(kBeyondChunk);
  bytes_.resize(size);
  if (Read(bytes_.data(), size)) AddConnection(header, bytes_);
}

void BagReader::AddConnection(const BagRecordHeader& header,
                              const std::vector<std::uint8_t>& data) {
  BagConnection connection;
  connection.topic = header.topic;
  const bool is_sound = ForEachBagField(data, [&](std::string_view name, std::string_view value) {
    if (name == "type") connection.type = value;
    if (name == "md5sum") connection.md5sum = value;
  });
  if (!is_sound) return Count(kBadConnection);
  connection_bytes_ += connection.topic.size() + connection.type.size() + connection.md5sum.size();
  if (connections_.size() >= kMaxConnections || connection_bytes_ > kMostConnectionBytes) {
    return Count(kManyConnections);
  }
  connections_[*header.connection] = std::move(connection);
}

// Closed bags repeat all connections there, after the chunks.
void BagReader::ReadConnectionsOfIndex() {
  if (std::exchange(has_read_index_, true) || !can_seek_ || index_at_ == 0) return;
  std::FILE* const file = file_.get();
  const off_t here = ftello(file);
  std::vector<std::uint8_t> bytes;
  const auto read = [&](std::uint32_t most) {
    std::uint32_t size = 0;
    if (std::fread(&size, sizeof size, 1, file) != 1 || size > most) return false;
    bytes.resize(size);
    return std::fread(bytes.data(), 1, size, file) == size;
  };
  if (index_at_ < file_size_ && fseeko(file, static_cast<off_t>(index_at_), SEEK_SET) == 0) {
    for (BagRecordHeader header; read(kLargestHeader) && header.Parse(bytes); header = {}) {
      if (!read(kLargestConnection)) break;
      const bool is_new = header.op == BagOp::kConnection && header.connection &&
                          !header.topic.empty() && connections_.count(*header.connection) == 0;
      if (is_new) AddConnection(header, bytes);
    }
  }
  std::clearerr(file);
  if (fseeko(file, here, SEEK_SET) != 0) End(Ending::Kind::kUnreadable, "it cannot be sought in");
}

void BagReader::OpenChunk(const BagRecordHeader& header, std::uint32_t size) {
  if (chunk_ && chunk_->unpacker != nullptr) return LoseFraming(kBadChunkLength);
  if (chunk_) {  // it states more bytes than it has
    Count(kBadChunkLength);
    chunk_.reset();
  }
  const bool is_packed = header.compression != "none";
  const std::uint32_t unpacked_size = header.size.value_or(0);
  // rosbag writes both sizes when it completes the chunk.
  const bool is_complete = size > 0 || unpacked_size > 0;
  if (!is_packed) {
    if (!is_complete) return;  // its records follow as if there were no chunk
    // The larger one is the safer one: the next chunk ends this one.
    chunk_ = Chunk();
    chunk_->has_two_lengths = size != unpacked_size;
    if (chunk_->has_two_lengths) Count(kBadChunkLength);
    chunk_->left = chunk_->left_in_file = std::max(size, unpacked_size);
    return;
  }
  const std::uint64_t most = std::uint64_t{unpacked_size} + unpacked_size / 8 + kPackedBlock;
  if (is_complete && size > most) return LoseFraming(kBadChunkLength);
  constexpr auto kToTheEnd = std::numeric_limits<std::uint64_t>::max();
  chunk_ = Chunk();
  chunk_->left_in_file = is_complete ? size : kToTheEnd;
  chunk_->left = is_complete ? unpacked_size : kToTheEnd;
  if (!header.IsOfChunk()) return LoseFraming(kNotUnpacked);
  const auto format =
      header.compression == "bz2" ? Decompressor::Format::kBzip2 : Decompressor::Format::kLz4;
  chunk_->unpacker = MakeUnpacker(format);
  if (!is_complete) return;
  if (unpacked_size <= kLargestKept) return UnpackChecked();
  if (can_seek_ && ahead_read_ == ahead_.size()) CheckAhead(format);
}

std::unique_ptr<Decompressor> BagReader::MakeUnpacker(Decompressor::Format format) {
  return std::make_unique<Decompressor>([this](const void** bytes) { return ReadPacked(bytes); },
                                        format);
}

bool BagReader::EndsInChunk() const {
  return std::feof(file_.get()) != 0 || std::ferror(file_.get()) != 0;
}

// Twice as much work, but no memory for all of it.
void BagReader::CheckAhead(Decompressor::Format format) {
  const off_t begin = ftello(file_.get());
  const std::uint64_t at = at_, left_in_file = chunk_->left_in_file;
  std::vector<char> unused(kPackedBlock);
  std::uint64_t unpacked = 0;
  ssize_t count = 1;
  while (count > 0 && unpacked <= chunk_->left) {
    count = chunk_->unpacker->Read(unused.data(), unused.size());
    unpacked += static_cast<std::uint64_t>(std::max<ssize_t>(count, 0));
  }
  if (count < 0 && !EndsInChunk()) return LoseFraming(kBadChecksum);
  if (begin < 0 || fseeko(file_.get(), begin, SEEK_SET) != 0) {
    return End(Ending::Kind::kUnreadable, "it cannot be sought in");
  }
  at_ = at;
  if (count == 0 && unpacked != chunk_->left) {
    Count(kOtherLength);
    chunk_->left = unpacked;
  }
  chunk_->left_in_file = left_in_file;
  chunk_->unpacker = MakeUnpacker(format);
}

// The checksum comes last. What fails it may be wrong in any place: a velocity, a load.
void BagReader::UnpackChecked() {
  chunk_->is_checked = true;
  unpacked_.clear();
  unpacked_read_ = 0;
  ssize_t count = 1;
  while (count > 0 && unpacked_.size() <= kLargestKept) {
    const std::size_t before = unpacked_.size();
    unpacked_.resize(before + kPackedBlock);
    count = chunk_->unpacker->Read(unpacked_.data() + before, kPackedBlock);
    unpacked_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }
  if (count < 0 && EndsInChunk()) {
    chunk_->left = std::numeric_limits<std::uint64_t>::max();  // the file ends in it
    return;
  }
  if (count != 0) return LoseFraming(kBadChecksum);
  if (chunk_->left != unpacked_.size()) Count(kOtherLength);
  chunk_->left = unpacked_.size();
}

void BagReader::CloseChunk() {
  // Its checksum is at its end.
  const bool is_read = chunk_->left == 0 && chunk_->unpacker != nullptr && !chunk_->is_checked;
  if (char next = 0; is_read && chunk_->unpacker->Read(&next, 1) < 0) Count(kUsedBefore);
  const std::uint64_t left = chunk_->left_in_file;
  chunk_.reset();
  SkipInFile(left);
}

}  // namespace kinescope::ros_bridge
