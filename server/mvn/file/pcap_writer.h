/// Writes datagrams as a capture that tcpdump, Wireshark and pcap_datagrams.h read: pcap with
/// nanoseconds, link type raw IP, each datagram a whole UDP packet between the ends that it came
/// from and went to (also one that came over TCP).
///
/// What is on the disk always ends with a whole packet, whatever ends the program: whole packets
/// are handed to the kernel at once, and after a write that failed (disk full) the file is cut back
/// to the last whole one. One thread.
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
  std::filesystem::path path;      // of the first file; take-0002.pcap and so on beside it
  std::uint64_t rotate_bytes = 0;  // begin a new file rather than exceed this; 0: never
  bool force = false;              // replace what is there, numbered files included
};

class PcapWriter {
 public:
  /// Creates the first file. A device or a pipe is written to as it is.
  /// @throws SourceError: a file is there already, the folder is not, it may not be written.
  explicit PcapWriter(const PcapWriterSettings& settings);
  ~PcapWriter();  // as Close(), but says nothing when that fails
  PcapWriter(const PcapWriter&) = delete;
  PcapWriter& operator=(const PcapWriter&) = delete;

  /// Reaches the file with the next Flush(), or before that when much has gathered.
  /// @throws SourceError naming the file, the reason and what is kept; the writer is of no use
  /// then.
  void Write(const Endpoint& from, const Endpoint& to, std::int64_t wall_nanos,
             std::string_view datagram);
  void Flush();  // @throws likewise
  void Close();  // @throws likewise; waits for the disk

  std::uint64_t datagrams() const;  // that are in the files
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
  std::string packet_;                  // being made
  std::uint64_t closed_datagrams_ = 0;  // in the files before this one
  std::uint64_t closed_bytes_ = 0;
};

}  // namespace kinescope::mvn
