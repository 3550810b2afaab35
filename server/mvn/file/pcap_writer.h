/// Writes datagrams as a capture that tcpdump, Wireshark and pcap_datagrams.h read: pcap, or pcapng
/// for names that end in .pcapng, with nanoseconds, link type raw IP, each datagram one complete
/// UDP packet with its sender and receiver (also if it was received over TCP).
///
/// The file always ends with a complete packet, however the program ends: complete packets are
/// passed to the kernel at once, and after a failed write (disk full) the file is truncated to the
/// last complete one. One thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/mvn/datagram_source.h"

namespace kinescope::mvn {

struct PcapWriterSettings {
  std::filesystem::path path;  // of the first file; the next ones are take-0002.pcap and so on in
                               // its folder
  std::uint64_t rotate_bytes = 0;  // start a new file before this size is exceeded; 0: never
  bool force = false;              // replace existing files, the numbered ones included
};

class PcapWriter {
 public:
  /// Creates the first file. A device or a pipe is written to directly.
  /// @throws SourceError: the file exists, the folder is missing, no permission to write.
  explicit PcapWriter(const PcapWriterSettings& settings);
  ~PcapWriter();  // like Close(), but ignores errors
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  /// Reaches the file with the next Flush(), or earlier when enough bytes are collected.
  /// @throws SourceError with the file, the reason and what was kept; the writer cannot be used
  /// afterwards.
  void Write(const Endpoint& from, const Endpoint& to, std::int64_t wall_nanos,
             std::string_view datagram);
  /// A comment on the next packet; after the last one, of the interface. Only pcapng keeps it.
  void Comment(std::string text);
  void Flush();  // @throws SourceError like Write()
  void Close();  // @throws SourceError like Write(); waits for the disk

  std::uint64_t datagrams() const;  // written to the files
  std::uint64_t bytes() const;      // of all files
  const std::vector<std::string>& files() const { return files_; }

 private:
  class File;

  std::filesystem::path PathOf(std::size_t number) const;  // from 1
  void OpenFirst();
  void OpenNext();
  template <class Action>
  void Try(Action&& action);

  PcapWriterSettings settings_;
  std::vector<std::string> files_;
  std::size_t number_ = 1;
  std::unique_ptr<File> file_;
  std::string packet_;                  // under construction
  std::vector<std::string> comments_;   // on the next packet
  std::int64_t newest_nanos_ = 0;       // of the packets, wall clock
  std::uint64_t closed_datagrams_ = 0;  // in the files before the current one
  std::uint64_t closed_bytes_ = 0;
};

}  // namespace kinescope::mvn
