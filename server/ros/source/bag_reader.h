/// Reads the records of a ROS 1 bag (format 2.0) from front to back. No ROS types; one thread.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/system/decompressor.h"
#include "core/system/input_file.h"

namespace kinescope::ros_bridge {

struct BagRecordHeader;

/// A topic as one node published it.
struct BagConnection {
  std::string topic;
  std::string type;    // "tf2_msgs/TFMessage"
  std::string md5sum;  // of the type's definition
};

struct BagMessage {
  const BagConnection* connection = nullptr;  // of the reader
  std::int64_t recorded_nanos = 0;            // since the Unix epoch
  std::size_t size = 0;                       // bytes, as the bag states it
  std::vector<std::uint8_t> bytes;            // empty if the message was not wanted or is too large
};

/// Opens `path` for a BagReader: as InputFile, but a file that is not compressed can seek, so that
/// large messages are skipped unread.
/// @throws SourceError with `path` and the remedy, also if it is not a ROS 1 bag.
InputFile OpenBagFile(const std::string& path);

/// Needs neither the index nor the end of a bag, so that it also reads one that was not closed, is
/// truncated, or is compressed as a whole. Where the record of a connection is damaged, the index
/// has it again. Memory is limited, whatever the lengths in the file
/// state: messages that are not wanted are skipped. Of a compressed chunk that fails its checksum
/// no message is used. One of more than 8 MiB is decompressed twice, to check it first; where the
/// bag is compressed as a whole, it is checked after its messages.
///
/// A damaged record is counted in defects(). If it has a wrong length, reading goes on with the
/// next chunk: where this one ends, or where the header of a chunk is found.
class BagReader {
 public:
  static constexpr std::size_t kLargestMessage = 64 << 20;  // bytes; larger ones are not delivered
  static constexpr std::size_t kMaxConnections = 65536;
  /// A defect by which nothing is lost.
  static constexpr char kOtherLength[] =
      "chunk of another length than it states, of which all was read";

  using IsWanted = std::function<bool(const BagConnection&)>;

  BagReader(InputFile file, IsWanted is_wanted);

  /// The next message in the order of the file, wanted or not. False at the end; see ending().
  [[nodiscard]] bool Next(BagMessage& message);

  struct Ending {
    enum class Kind {
      kClosed,      // the index follows the last message
      kTruncated,   // the file ends earlier: it was not closed, or not copied completely
      kDamaged,     // the position of the next record is unknown
      kUnreadable,  // the system or the decompression of the file failed
      kEncrypted,
    };
    Kind kind = Kind::kClosed;
    std::string reason;  // of kDamaged and kUnreadable
  };
  /// Valid after Next() returned false.
  const Ending& ending() const { return ending_; }

  /// Connections so far, by the number that the bag gives them.
  const std::map<std::uint32_t, BagConnection>& connections() const { return connections_; }
  /// Damaged records by reason.
  const std::map<std::string, std::uint64_t>& defects() const { return defects_; }

 private:
  // The chunk that is being read. Its end in the file is known, whatever its records contain.
  struct Chunk {
    std::uint64_t left = 0;                  // bytes, decompressed
    std::uint64_t left_in_file = 0;          // bytes, as stored
    bool has_two_lengths = false;            // which differ, so that its end is not sure
    bool is_checked = false;                 // all of it is in unpacked_
    std::unique_ptr<Decompressor> unpacker;  // null: not compressed
  };

  /// One record; true if it is a message.
  bool ReadRecord(BagMessage& message);
  bool ReadMessage(const BagRecordHeader& header, std::uint32_t size, BagMessage& message);
  void ReadConnection(const BagRecordHeader& header, std::uint32_t size);
  /// `data`: of its record.
  void AddConnection(const BagRecordHeader& header, const std::vector<std::uint8_t>& data);
  void ReadConnectionsOfIndex();
  void OpenChunk(const BagRecordHeader& header, std::uint32_t size);
  /// Unpacks the whole chunk, which only then can be checked.
  void UnpackChecked();
  void CheckAhead(Decompressor::Format format);
  std::unique_ptr<Decompressor> MakeUnpacker(Decompressor::Format format);
  bool EndsInChunk() const;  // the file does
  void CloseChunk();

  // False: the rest of the record is not there; that has been noted.
  bool Read(void* to, std::size_t size);
  bool ReadUnpacked(char* to, std::size_t size);
  bool ReadChecked(void* to, std::size_t size);
  bool ReadFile(void* to, std::size_t size);
  bool Skip(std::uint64_t size);
  bool SkipInFile(std::uint64_t size);
  ssize_t ReadPacked(const void** bytes);        // the next compressed bytes of the chunk
  std::size_t Take(void* to, std::size_t size);  // bytes of the file; fewer at its end
  bool IsAtEnd();
  /// Goes on to where the next chunk begins; false if there is none.
  bool FindChunk();

  void Count(const char* reason) { ++defects_[reason]; }
  /// The position of the next record is unknown: counts that, and goes on with the next chunk.
  void LoseFraming(const char* reason);
  void EndOfFile();
  void End(Ending::Kind kind, std::string reason = "");

  InputFile file_;
  const IsWanted is_wanted_;
  bool can_seek_ = false;
  std::uint64_t file_size_ = 0;  // if it can seek
  std::uint64_t at_ = 0;         // bytes of the file that were read
  std::uint64_t index_at_ = 0;   // as the bag states it; 0: not closed
  std::optional<Chunk> chunk_;
  std::string ahead_;           // bytes of the file that FindChunk() read too far
  std::size_t ahead_read_ = 0;  // of them, that were read again
  std::vector<char> packed_;    // what ReadPacked() returned
  std::vector<char> unpacked_;  // of a chunk that is checked
  std::size_t unpacked_read_ = 0;
  std::vector<std::uint8_t> bytes_;  // of a header or connection
  std::map<std::uint32_t, BagConnection> connections_;
  std::size_t connection_bytes_ = 0;
  std::map<std::string, std::uint64_t> defects_;
  bool has_read_index_ = false;
  bool has_ended_ = false;
  Ending ending_;
};

}  // namespace kinescope::ros_bridge
