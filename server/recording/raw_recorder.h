/// Records the datagrams of a live stream while it is shown: started and stopped by the page, fed
/// by the reading thread, written by threads of its own. A slow or full disk costs datagrams of the
/// recording, which are counted, and never delays the stream.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "server/mvn/datagram_source.h"
#include "server/mvn/file/pcap_recorder.h"
#include "server/recording/folder.h"
#include "server/recording/stream_description.h"

namespace kinescope::recording {

class RawRecorder : public mvn::DatagramSink {
 public:
  enum class State { kOff, kOn, kSaving };
  struct Status {
    State state = State::kOff;
    std::string file;         // name of the newest recording; "": none yet
    double secs = 0;          // since it was started; of one that has ended: its length
    std::uint64_t bytes = 0;  // of it
    std::uint64_t datagrams = 0;
    std::uint64_t dropped = 0;  // because the disk was too slow
    std::string problem;        // why it ended by itself; ""
    double bytes_per_sec = 0;   // that the stream needs, over the last seconds
  };

  /// Space that is left on the disk for everything else, such as marks.
  static constexpr std::uintmax_t kSpareBytes = std::uintmax_t{32} << 20;

  /// `folder` is borrowed. `spare_bytes`: for tests.
  explicit RawRecorder(const Folder& folder, std::uintmax_t spare_bytes = kSpareBytes);
  ~RawRecorder() override;  // saves what is recorded
  RawRecorder(const RawRecorder&) = delete;
  RawRecorder& operator=(const RawRecorder&) = delete;

  static constexpr const char* kEnding = ".pcapng";

  /// Starts to record to a new file `stem` + kEnding of the folder. Any thread but the reading one.
  /// @return "", or why not: it records already, a missing folder, a full disk
  [[nodiscard]] std::string Start(const std::string& stem);
  /// Returns at once; the rest is saved meanwhile.
  void Stop();
  /// Writes `text` as the comment of the next datagram, if it records. Any thread.
  void Comment(const std::string& text);
  /// Waits until `file` is saved; returns at once if it is, or if it is being recorded.
  void AwaitSaved(const std::string& file);

  void OnDatagram(const mvn::ReceivedDatagram& datagram) override;  // reading thread

  Status status() const;  // any thread

 private:
  void Run();
  void End(std::string problem);
  void TakeCounters(const mvn::PcapRecorder& recorder);
  void WatchDisk();
  void MeasureRate(std::int64_t now_nanos);

  const Folder& folder_;
  const std::uintmax_t spare_bytes_;
  std::atomic<std::uint64_t> bytes_seen_{0};  // of the stream, as packets of a file

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_:
  StreamDescription description_;
  std::unique_ptr<mvn::PcapRecorder> recorder_;  // null: off
  std::unique_ptr<mvn::PcapRecorder> ending_;    // to be saved
  bool is_saving_ = false;
  bool has_description_ = false;    // in the file
  std::int64_t started_nanos_ = 0;  // monotonic
  Status last_;                     // without what recorder_ counts
  bool is_closing_ = false;
  // The keeper's:
  std::int64_t rated_nanos_ = 0;
  std::uint64_t rated_bytes_ = 0;

  std::thread keeper_;  // last: starts when all other members exist
};

}  // namespace kinescope::recording
