#include "server/mvn/file/pcap_recorder.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "core/system/errors.h"
#include "server/mvn/file/packet.h"

namespace kinescope::mvn {
namespace {

// Short enough that a kill costs little, long enough that the thread is not woken for each
// datagram.
constexpr std::chrono::milliseconds kFlushEvery(200);
constexpr std::size_t kWakeBytes = 256 * 1024;

}  // namespace

PcapRecorder::PcapRecorder(const PcapWriterSettings& settings, WhenFull when_full,
                           std::size_t queue_bytes)
    : when_full_(when_full),
      queue_bytes_(queue_bytes),
      wake_bytes_(std::min(kWakeBytes, queue_bytes / 2)),
      writer_(settings) {
  counters_.files = writer_.files();
  counters_.bytes = writer_.bytes();
  thread_ = std::thread([this] { Run(); });
}

PcapRecorder::~PcapRecorder() {
  try {
    Finish();
  } catch (const SourceError&) {
    // Callers that need the error call Finish().
  }
}

void PcapRecorder::OnDatagram(const ReceivedDatagram& datagram) {
  const Entry entry{datagram.from, datagram.to, datagram.arrival.wall_nanos, datagram.bytes.size(),
                    false};
  static_assert(std::is_trivially_copyable_v<Entry>, "it is copied as bytes");
  const std::size_t size = sizeof entry + entry.size;
  std::unique_lock lock(mutex_);
  if (entry.size > kMaxUdpPayload) {
    ++counters_.too_long;
    return;
  }
  const auto has_room = [&] { return queue_.empty() || queue_.size() + size <= queue_bytes_; };
  if (when_full_ == WhenFull::kWait) {
    emptied_.wait(lock, [&] { return has_room() || failure_ != nullptr; });
  }
  if (failure_ != nullptr) std::rethrow_exception(failure_);
  if (!has_room()) {
    ++counters_.dropped;
    return;
  }
  queue_.append(reinterpret_cast<const char*>(&entry), sizeof entry).append(datagram.bytes);
  if (queue_.size() >= wake_bytes_) filled_.notify_one();
}

void PcapRecorder::Comment(const std::string& text) {
  Entry entry;
  entry.size = text.size();
  entry.is_comment = true;
  const std::lock_guard lock(mutex_);
  if (queue_.size() + sizeof entry + text.size() > queue_bytes_) return;
  queue_.append(reinterpret_cast<const char*>(&entry), sizeof entry).append(text);
}

void PcapRecorder::Check() {
  const std::lock_guard lock(mutex_);
  if (failure_ != nullptr) std::rethrow_exception(failure_);
}

void PcapRecorder::Finish() {
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  filled_.notify_one();
  if (thread_.joinable()) thread_.join();
  Check();
}

PcapRecorder::Counters PcapRecorder::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

void PcapRecorder::WriteAll(const std::string& queue) {
  for (std::size_t at = 0; at < queue.size();) {
    Entry entry;
    std::memcpy(&entry, queue.data() + at, sizeof entry);
    at += sizeof entry;
    const std::string_view bytes(queue.data() + at, entry.size);
    if (entry.is_comment) {
      writer_.Comment(std::string(bytes));
    } else {
      writer_.Write(entry.from, entry.to, entry.wall_nanos, bytes);
    }
    at += entry.size;
  }
}

void PcapRecorder::Run() {
  std::string queue;  // swapped with queue_, so that memory is reused
  std::exception_ptr failure;
  for (bool at_end = false; !at_end && failure == nullptr;) {
    {
      std::unique_lock lock(mutex_);
      filled_.wait_for(lock, kFlushEvery,
                       [this] { return finished_ || queue_.size() >= wake_bytes_; });
      queue.clear();
      queue.swap(queue_);
      at_end = finished_;
    }
    emptied_.notify_all();
    try {
      WriteAll(queue);
      at_end ? writer_.Close() : writer_.Flush();
    } catch (const SourceError&) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    counters_.datagrams = writer_.datagrams();
    counters_.bytes = writer_.bytes();
    counters_.files = writer_.files();
    failure_ = failure;
  }
  emptied_.notify_all();
}

}  // namespace kinescope::mvn
