/// Records datagrams to disk from a thread of its own: a disk that stalls must not keep the socket
/// from being read. Owned and called by one thread, the one that reads the source.
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
  /// What to do with a datagram when the disk is so far behind that the queue is full.
  enum class WhenFull {
    kDrop,  // a live source, which cannot be told to wait
    kWait,  // a file
  };

  /// About fifteen seconds of four people at 240 Hz with all message types.
  static constexpr std::size_t kQueueBytes = 64 << 20;

  /// Creates the file. @throws SourceError as PcapWriter does.
  PcapRecorder(const PcapWriterSettings& settings, WhenFull when_full,
               std::size_t queue_bytes = kQueueBytes);
  ~PcapRecorder() override;  // writes what is queued, as far as that can be done
  PcapRecorder(const PcapRecorder&) = delete;
  PcapRecorder& operator=(const PcapRecorder&) = delete;

  /// Copies the datagram; its wall clock is the time in the file. In the file after 0.5 s at most.
  /// @throws SourceError what the disk said since the last call.
  void OnDatagram(const ReceivedDatagram& datagram) override;

  /// @throws SourceError likewise; call it now and then while nothing comes.
  void Check();

  /// Waits until everything is on the disk. Nothing may follow. @throws SourceError likewise.
  void Finish();

  struct Counters {
    std::uint64_t datagrams = 0;  // in the files
    std::uint64_t bytes = 0;      // of the files
    std::uint64_t dropped = 0;    // because the queue was full
    std::uint64_t too_long = 0;   // for a UDP packet: TCP can carry 52 bytes more
    std::vector<std::string> files;
  };
  Counters counters() const;

 private:
  // How a datagram lies in the queue; its bytes follow.
  struct Entry {
    Endpoint from, to;
    std::int64_t wall_nanos = 0;
    std::size_t size = 0;
  };

  void Run();
  void WriteAll(const std::string& queue);

  const WhenFull when_full_;
  const std::size_t queue_bytes_;
  const std::size_t wake_bytes_;  // so much queued wakes the thread before its time

  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::condition_variable emptied_;
  std::string queue_;           // guarded by mutex_
  bool finished_ = false;       // guarded by mutex_
  std::exception_ptr failure_;  // guarded by mutex_; the thread has ended
  Counters counters_;           // guarded by mutex_

  PcapWriter writer_;  // the thread's, once it runs
  std::thread thread_;
};

}  // namespace kinescope::mvn
