#include "server/recording/raw_recorder.h"

#include <chrono>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"

namespace kinescope::recording {
namespace {

constexpr std::chrono::milliseconds kWatchEvery(500);
constexpr std::uint64_t kPacketBytes = 32 + 20 + 8;  // around a datagram in the file, IPv4
constexpr double kMb = 1e6;

std::string Megabytes(std::uintmax_t bytes) {
  const std::string tenths =
      std::to_string(static_cast<std::uintmax_t>(static_cast<double>(bytes) / kMb * 10));
  const std::string padded = tenths.size() < 2 ? "0" + tenths : tenths;
  return padded.substr(0, padded.size() - 1) + "." + padded.back() + " MB";
}

// Messages for all clients do not need the folders of this machine.
std::string WithoutFolder(std::string text, const std::filesystem::path& folder) {
  const std::string prefix = (folder / "").string();
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) {
    text.erase(at, prefix.size());
  }
  return text;
}

}  // namespace

RawRecorder::RawRecorder(const Folder& folder, std::uintmax_t spare_bytes)
    : folder_(folder), spare_bytes_(spare_bytes), keeper_([this] { Run(); }) {}

RawRecorder::~RawRecorder() {
  Stop();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_closing_ = true;
  }
  changed_.notify_all();
  keeper_.join();
}

std::string RawRecorder::Start(const std::string& stem) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (recorder_ != nullptr) return "a recording runs already: " + last_.file + "; stop it first";
    if (ending_ != nullptr || is_saving_) {
      return "the recording before, " + last_.file +
             ", is still being saved; try again in a second";
    }
  }
  std::string wrong = folder_.Prepare();
  if (!wrong.empty()) return wrong;
  const auto free = folder_.free_bytes();
  if (free && *free < spare_bytes_) {
    return "the disk is full: " + Megabytes(*free) + " are free, and " + Megabytes(spare_bytes_) +
           " are kept for marks; delete files, or choose another disk with --recordings_folder";
  }
  const std::string file = stem + kEnding;
  std::unique_ptr<mvn::PcapRecorder> recorder;
  try {
    mvn::PcapWriterSettings settings;
    settings.path = folder_.path() / file;
    recorder = std::make_unique<mvn::PcapRecorder>(settings, mvn::PcapRecorder::WhenFull::kDrop);
  } catch (const SourceError& error) {
    return error.what();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (recorder_ != nullptr) return "a recording runs already: " + last_.file + "; stop it first";
  recorder_ = std::move(recorder);
  has_description_ = false;
  started_nanos_ = MonotonicNanos();
  last_ = {State::kOn, file, 0, 0, 0, 0, "", last_.bytes_per_sec};
  return "";
}

void RawRecorder::Stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (recorder_ != nullptr) End("");
}

void RawRecorder::Comment(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (recorder_ != nullptr) recorder_->Comment(text);
}

// @pre mutex_ is held, and it records
void RawRecorder::End(std::string problem) {
  last_.secs = Secs(MonotonicNanos() - started_nanos_);
  last_.problem = WithoutFolder(std::move(problem), folder_.path());
  last_.state = State::kSaving;
  ending_ = std::move(recorder_);
  changed_.notify_all();
}

void RawRecorder::AwaitSaved(const std::string& file) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [&] { return last_.file != file || last_.state != State::kSaving; });
}

void RawRecorder::OnDatagram(const mvn::ReceivedDatagram& datagram) {
  bytes_seen_ += datagram.bytes.size() + kPacketBytes;
  const std::lock_guard<std::mutex> lock(mutex_);
  description_.OnDatagram(datagram);
  if (recorder_ == nullptr) return;
  try {
    if (!has_description_) {
      has_description_ = true;
      description_.PassTo(*recorder_, datagram.arrival);
    }
    recorder_->OnDatagram(datagram);
  } catch (const SourceError& error) {
    End(error.what());
  }
}

RawRecorder::Status RawRecorder::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Status status = last_;
  const mvn::PcapRecorder* const recorder = recorder_ != nullptr ? recorder_.get() : ending_.get();
  if (recorder != nullptr) {
    const mvn::PcapRecorder::Counters counters = recorder->counters();
    status.bytes = counters.bytes;
    status.datagrams = counters.datagrams;
    status.dropped = counters.dropped;
  }
  if (recorder_ != nullptr) status.secs = Secs(MonotonicNanos() - started_nanos_);
  return status;
}

// @pre mutex_ is held
void RawRecorder::TakeCounters(const mvn::PcapRecorder& recorder) {
  const mvn::PcapRecorder::Counters counters = recorder.counters();
  last_.bytes = counters.bytes;
  last_.datagrams = counters.datagrams;
  last_.dropped = counters.dropped;
}

// @pre mutex_ is held
void RawRecorder::WatchDisk() {
  if (recorder_ == nullptr) return;
  try {
    recorder_->Check();
  } catch (const SourceError& error) {
    return End(error.what());
  }
  const auto free = folder_.free_bytes();
  if (!free || *free >= spare_bytes_) return;
  End("the disk is full: recording stopped while " + Megabytes(*free) +
      " were left, which are kept for marks; what was recorded is saved");
}

void RawRecorder::MeasureRate(std::int64_t now_nanos) {
  const std::uint64_t bytes = bytes_seen_;
  const double secs = Secs(now_nanos - rated_nanos_);
  if (rated_nanos_ != 0 && secs < 1) return;
  const double rate = static_cast<double>(bytes - rated_bytes_) / secs;
  const bool is_first = rated_nanos_ == 0 || last_.bytes_per_sec == 0;
  if (rated_nanos_ != 0) last_.bytes_per_sec = is_first ? rate : 0.5 * (last_.bytes_per_sec + rate);
  rated_nanos_ = now_nanos;
  rated_bytes_ = bytes;
}

void RawRecorder::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait_for(lock, kWatchEvery, [this] { return ending_ != nullptr || is_closing_; });
    MeasureRate(MonotonicNanos());
    WatchDisk();
    if (ending_ == nullptr) {
      if (is_closing_) return;
      continue;
    }
    const std::unique_ptr<mvn::PcapRecorder> ending = std::move(ending_);
    is_saving_ = true;
    TakeCounters(*ending);
    lock.unlock();
    std::string problem;
    try {
      ending->Finish();
    } catch (const SourceError& error) {
      problem = WithoutFolder(error.what(), folder_.path());
    }
    lock.lock();
    TakeCounters(*ending);
    if (last_.problem.empty()) last_.problem = std::move(problem);
    last_.state = State::kOff;
    is_saving_ = false;
    changed_.notify_all();
  }
}

}  // namespace kinescope::recording
