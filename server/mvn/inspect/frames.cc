#include "server/mvn/inspect/frames.h"

#include <algorithm>
#include <cmath>

namespace kinescope::mvn {
namespace {

constexpr std::int32_t kFarthestAhead = 10'000;  // until the time code decides: 40 s at 240 Hz
constexpr std::int32_t kNextMillis = 2'000;      // from the first to the second frame of a new run
constexpr double kMaxIrregular = 0.02;           // largest share of steps shorter than usual
constexpr int kFramePatience = 256;  // datagrams that a doubtful one waits for its successor

}  // namespace

void FrameTrack::Add(int type, std::uint32_t counter, std::uint32_t time_code_millis,
                     const Arrival& arrival) {
  if (!BelongsHere(counter, time_code_millis)) {
    if (!ConfirmsRestart(type, counter, time_code_millis, arrival)) return;
  } else if (doubt_ && ++doubt_->others_since > kFramePatience) {
    doubt_.reset();
  }
  Take(type, counter, time_code_millis, arrival);
}

bool FrameTrack::BelongsHere(std::uint32_t counter, std::uint32_t millis) const {
  if (!run_first_ || confirmation_ == Confirmation::kConfirmed) return true;
  const std::int32_t ahead = Ahead(counter, run_newest_);
  if (ahead <= -static_cast<std::int32_t>(kRemembered)) return false;
  switch (line_.Fits(counter, millis)) {
    case TimeCodeLine::Fit::kYes: return true;
    case TimeCodeLine::Fit::kNo: return false;
    case TimeCodeLine::Fit::kUnknown: break;
  }
  return ahead < kFarthestAhead;
}

bool FrameTrack::ConfirmsRestart(int type, std::uint32_t counter, std::uint32_t millis,
                                 const Arrival& arrival) {
  const auto goes_on = [&](const Doubt& doubt) {
    const std::int32_t counts = Ahead(counter, doubt.counter);
    const std::int32_t time = Ahead(millis, doubt.millis);
    if (counts == 0) return time == 0 && type != doubt.type;
    return counts > 0 && counts < static_cast<std::int32_t>(kRemembered) && time >= 0 &&
           time < kNextMillis;
  };
  if (!doubt_ || !goes_on(*doubt_)) {
    doubt_ = Doubt{type, counter, millis, arrival, 0};
    return false;
  }
  const Doubt first = *doubt_;
  doubt_.reset();
  CloseRun();
  ++restarts_;
  Take(first.type, first.counter, first.millis, first.arrival);
  return true;
}

void FrameTrack::CloseRun() {
  closed_counts_ += Ahead(run_newest_, *run_first_);
  closed_millis_ += Ahead(run_newest_millis_, run_first_millis_);
  run_first_.reset();
  line_.Restart();
  clock_.Restart();
  remembered_.fill(Frame());
}

void FrameTrack::Take(int type, std::uint32_t counter, std::uint32_t millis,
                      const Arrival& arrival) {
  Frame& frame = remembered_[counter % kRemembered];
  if (!run_first_ || Ahead(counter, run_newest_) > 0) {
    BeginFrame(counter, millis, arrival);
    frame = Frame{true, counter, {}};
  } else if (!frame.is_used || frame.counter != counter) {  // arrived after later ones
    ++frames_;
    if (Ahead(counter, *run_first_) < 0) {
      run_first_ = counter;
      run_first_millis_ = millis;
    }
    frame = Frame{true, counter, {}};
  }
  const auto index = static_cast<std::size_t>(type);
  if (frame.types.test(index)) return;  // repeated, or another part of it
  frame.types.set(index);
  ++with_type_[index];
}

void FrameTrack::BeginFrame(std::uint32_t counter, std::uint32_t millis, const Arrival& arrival) {
  ++frames_;
  line_.Add(counter, millis);
  if (!run_first_) {
    run_first_ = counter;
    run_first_millis_ = millis;
  } else {
    const auto step = static_cast<std::uint32_t>(Ahead(counter, run_newest_));
    if (step < kSteps) ++steps_[step];
    smallest_step_ = smallest_step_ == 0 ? step : std::min(smallest_step_, step);
    largest_step_ = std::max(largest_step_, step);
  }
  run_newest_ = counter;
  run_newest_millis_ = millis;
  if (!first_counter_) first_counter_ = counter;
  last_counter_ = counter;

  delays_.Add(
      std::max<std::int64_t>(arrival.wall_nanos - clock_.Stamp(counter, millis, arrival), 0));
  if (!first_arrival_) {
    first_arrival_ = arrival;
  } else if (arrival.monotonic_nanos - last_arrival_ > longest_silence_) {
    longest_silence_ = arrival.monotonic_nanos - last_arrival_;
    longest_silence_began_ = last_arrival_;
  }
  last_arrival_ = arrival.monotonic_nanos;
}

double FrameTrack::usual_step() const {
  const auto most = std::max_element(steps_.begin(), steps_.end());
  if (*most == 0) return 1;
  const auto index = static_cast<std::size_t>(most - steps_.begin());
  // Two alternating steps, as a rate causes that does not divide the acquisition rate. Beside 1, a
  // 2 is usually a lost frame, so it must be nearly as frequent.
  const std::uint64_t least = index == 1 ? *most * 2 / 3 : *most / 4;
  double frames = 0;
  double counts = 0;
  for (std::size_t i = index > 1 ? index - 1 : 1; i <= std::min(index + 1, kSteps - 1); ++i) {
    if (i != index && steps_[i] <= least) continue;
    frames += static_cast<double>(steps_[i]);
    counts += static_cast<double>(i * steps_[i]);
  }
  return counts / frames;
}

std::optional<std::uint64_t> FrameTrack::lost() const {
  if (!run_first_) return 0;
  std::uint64_t all = 0;
  std::uint64_t shorter = 0;
  for (std::size_t step = 1; step < kSteps; ++step) {
    all += steps_[step];
    if (static_cast<double>(step) <= usual_step() - 1) shorter += steps_[step];
  }
  if (static_cast<double>(shorter) > kMaxIrregular * static_cast<double>(all)) return std::nullopt;
  const double counts = closed_counts_ + Ahead(run_newest_, *run_first_);
  const double runs = static_cast<double>(restarts_) + 1;
  const double missing = counts / usual_step() + runs - static_cast<double>(frames_);
  // With a fractional step, both ends of a run are uncertain by one frame.
  const double slack = usual_step() == std::floor(usual_step()) ? 0 : runs;
  return missing <= slack ? 0 : static_cast<std::uint64_t>(std::llround(missing));
}

double FrameTrack::arrival_rate_hz() const {
  if (frames_ < 2 || last_arrival_ <= first_arrival_->monotonic_nanos) return 0;
  return static_cast<double>(frames_ - 1) * 1e9 /
         static_cast<double>(last_arrival_ - first_arrival_->monotonic_nanos);
}

double FrameTrack::capture_rate_hz() const {
  if (!run_first_) return 0;
  const double counts = closed_counts_ + Ahead(run_newest_, *run_first_);
  const double millis = closed_millis_ + Ahead(run_newest_millis_, run_first_millis_);
  return counts > 0 && millis > 0 ? counts * 1000 / millis : 0;
}

}  // namespace kinescope::mvn
