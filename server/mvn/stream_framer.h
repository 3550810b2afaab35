/// Cuts a byte stream into MVN datagrams: over TCP, and in a file of raw datagrams, they follow
/// each other without separators, and each header states its own length. Other bytes are skipped up
/// to the next datagram and counted. The input is untrusted: memory is limited, and a wrong length
/// costs at most the datagram that states it. One thread.
///
/// - A datagram is its header and the payload that the header announces. Senders before 2018
///   announce none: there the length follows from type, number of items and content; where the
///   format had two sizes, from where the next datagram begins.
/// - The announced length is shortened if another datagram begins inside. Values that a human can
///   have never spell "MXTP02"; in names (12, 13) an id string counts only if no text follows it.
/// - If a datagram included the first bytes of the next one, these bytes are read again, so that
///   the next one is complete.
/// - A datagram is returned as soon as its last byte is added. The result does not depend on how
///   the bytes were divided into calls.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kinescope::mvn {

class StreamFramer {
 public:
  StreamFramer();

  /// Adds the next bytes of the stream. Call Next() until it returns nothing before the next
  /// Append(): then at most 64 kB are kept, and pieces of at most 64 kB cause no allocation.
  void Append(std::string_view bytes);

  /// End of the stream: the remaining bytes will not become more complete.
  void End();

  /// The next datagram, or a piece of foreign text between datagrams (the assembler counts its
  /// kind); nullopt: more bytes are needed. Valid until the next Append().
  std::optional<std::string_view> Next();

  /// Number of searches for the next "MXTP", after foreign bytes or a wrong length.
  std::uint64_t resyncs() const { return resyncs_; }
  /// Bytes that were returned neither as a datagram nor as text.
  std::uint64_t skipped_bytes() const { return skipped_bytes_; }
  /// Bytes returned twice, at the end of a datagram and at the beginning of the next.
  std::uint64_t reread_bytes() const { return reread_bytes_; }
  /// Bytes that are not returned yet.
  std::size_t pending_bytes() const { return buffer_.size() - start_; }

 private:
  std::string_view left() const { return std::string_view(buffer_).substr(start_); }

  std::optional<std::size_t> DatagramSize();
  std::optional<std::size_t> SizeOfForeign();
  std::optional<std::size_t> StepBack();
  std::string_view Take(std::size_t size, bool is_datagram);

  std::string buffer_;
  std::size_t start_ = 0;      // of the bytes not returned yet
  std::size_t searched_ = 0;   // in left(), no id string begins before this position, except at 0
  std::size_t last_size_ = 0;  // size of the datagram directly before start_; 0: there is none
  bool has_ended_ = false;
  std::bitset<100> has_short_items_;  // by type: an old sender with the shorter of two sizes
  std::uint64_t resyncs_ = 0;
  std::uint64_t skipped_bytes_ = 0;
  std::uint64_t reread_bytes_ = 0;
};

}  // namespace kinescope::mvn
