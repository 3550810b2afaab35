/// Cuts a stream of bytes into MVN datagrams: over TCP, and in a file of raw datagrams, they follow
/// each other with nothing between them but what each header says of its own length. What is no
/// datagram is passed over up to the next one and counted. Untrusted input: memory is bounded, and
/// a length that lies costs no more than the datagram that tells it. One thread.
///
/// - A datagram is its header and the payload that the header announces. Senders from before 2018
///   announce none: there the length follows from type, number of items and content, and where the
///   format had two sizes, from where the next datagram begins.
/// - What is announced is cut short where another datagram begins inside: numbers that a human can
///   have never spell "MXTP02", and in names (12, 13) it counts only where what follows is no text.
/// - The other way round, when a datagram swallowed the first bytes of the next one, those bytes
/// are
///   read again, so that the next one is whole.
/// - A datagram is given on with its last byte, and what comes out does not depend on how the bytes
///   were cut into calls.
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

  /// Takes the next bytes of the stream. Call Next() until it has nothing more before the next
  /// Append(): then at most 64 kB are kept, and with pieces of at most 64 kB nothing is allocated.
  void Append(std::string_view bytes);

  /// Nothing more will come: what is left is as whole as it will ever be.
  void End();

  /// The next datagram, or a piece of foreign text that stood between datagrams (the assembler
  /// tells what it was); nullopt: more bytes are needed. Valid until the next Append().
  std::optional<std::string_view> Next();

  /// How often the next "MXTP" was searched for: foreign bytes, or a length that lied.
  std::uint64_t resyncs() const { return resyncs_; }
  /// Bytes that were neither handed out as a datagram nor as text.
  std::uint64_t skipped_bytes() const { return skipped_bytes_; }
  /// Bytes handed out twice, at the end of a datagram and at the beginning of the next.
  std::uint64_t reread_bytes() const { return reread_bytes_; }
  /// Bytes that wait for more.
  std::size_t pending_bytes() const { return buffer_.size() - start_; }

 private:
  std::string_view left() const { return std::string_view(buffer_).substr(start_); }

  std::optional<std::size_t> DatagramSize();
  std::optional<std::size_t> SizeOfForeign();
  std::optional<std::size_t> StepBack();
  std::string_view Take(std::size_t size, bool is_datagram);

  std::string buffer_;
  std::size_t start_ = 0;      // of what was not handed out yet
  std::size_t searched_ = 0;   // no id string begins in left() before this, but at 0
  std::size_t last_size_ = 0;  // of the datagram just before start_; 0: something else is there
  bool has_ended_ = false;
  std::bitset<100> has_short_items_;  // by type: an old sender with the shorter of two sizes
  std::uint64_t resyncs_ = 0;
  std::uint64_t skipped_bytes_ = 0;
  std::uint64_t reread_bytes_ = 0;
};

}  // namespace kinescope::mvn
