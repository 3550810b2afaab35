/// Records datagrams to disk on its own thread, so that a slow disk does not block the socket.
/// Owned and called by the thread that reads the source.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/mvn/datagram_source.h"
#include "server/mvn/file/pcap_writer.h"

namespace kinescope::mvn {

class PcapRecorder : public DatagramSink {
 public:
  /// What happens to a datagram when the queue is full because the disk is too slow.
  enum class WhenFull {
    kDrop,  // for a live source, which cannot wait
    kWait,  // for a file
  };

  /// About 15 s of four people at 240 Hz with all message types.
  static constexpr std::size_t kQueueBytes = 64 << 20;

  /// Creates the file. @throws SourceError as PcapWriter does.
  PcapRecorder(const PcapWriterSettings& settings, WhenFull when_full,
               std::size_t queue_bytes = kQueueBytes);
  ~PcapRecorder() override;  // writes the queue as far as possible
  PcapRecorder(const PcapRecorder&) = delete;
  PcapRecorder& operator=(const PcapRecorder&) = delete;

  /// Copies the datagram; its wall-clock receive time is its time in the file. It is in the file
  /// after at most 0.5 s. @throws SourceError if writing failed since the last call.
  void OnDatagram(const ReceivedDatagram& datagram) override;

  /// A comment on the next datagram that is written (PcapWriter::Comment). Any thread.
  void Comment(const std::string& text);

  /// @throws SourceError if writing failed; call it now and then while no datagrams arrive.
  void Check();

  /// Waits until everything is on the disk; no datagram may follow. @throws SourceError if writing
  /// failed.
  void Finish();

  struct Counters {
    std::uint64_t datagrams = 0;  // written to the files
    std::uint64_t bytes = 0;      // of the files
    std::uint64_t dropped = 0;    // because the queue was full
    std::uint64_t too_long = 0;   // too long for a UDP packet: TCP can carry 52 bytes more
    std::vector<std::string> files;
  };
  Counters counters() const;

 private:
  // An entry of the queue; the bytes of the datagram follow it.
  struct Entry {
    Endpoint from, to;
    std::int64_t wall_nanos = 0;
    std::size_t size = 0;
    bool is_comment = false;
  };

  void Run();
  void WriteAll(const std::string& queue);

  const WhenFull when_full_;
  const std::size_t queue_bytes_;
  const std::size_t wake_bytes_;  // this many queued bytes wake the thread early

  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::condition_variable emptied_;
  std::string queue_;           // guarded by mutex_
  bool finished_ = false;       // guarded by mutex_
  std::exception_ptr failure_;  // guarded by mutex_; the thread has ended
  Counters counters_;           // guarded by mutex_

  PcapWriter writer_;  // used by the recorder's thread once it runs
  std::thread thread_;
};

}  // namespace kinescope::mvn
