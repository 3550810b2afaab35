#include "server/app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/system/json_text.h"

namespace kinescope::app {
namespace {

using Clock = std::chrono::steady_clock;

ProgressForm& FormOfAll() {
  static ProgressForm form = ProgressForm::kAuto;
  return form;
}

ProgressForm FormHere() {
  const ProgressForm form = FormOfAll();
  const bool is_seen = form == ProgressForm::kJson || isatty(STDERR_FILENO) == 1;
  return is_seen ? form : ProgressForm::kOff;
}

double Thousandths(double value) { return std::round(value * 1e3) / 1e3; }

}  // namespace

void SetProgressForm(ProgressForm form) { FormOfAll() = form; }

Progress::Progress(std::string what, int total, double quiet_secs)
    : what_(std::move(what)), total_(total), quiet_secs_(quiet_secs), form_(FormHere()) {}

Progress::~Progress() {
  if (form_ == ProgressForm::kAuto && drawn_done_ > 0) std::fputc('\n', stderr);
  try {
    const bool is_quiet = quiet_secs_ > 0 && drawn_done_ == 0;
    if (form_ == ProgressForm::kJson && drawn_done_ < done_ && !is_quiet) PrintJson();
  } catch (const std::exception&) {
    // There is no memory for the last line; a destructor must not throw.
  }
}

double Progress::secs() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::Step() {
  ++done_;
  if (total_ > 0) total_ = std::max(total_, done_);  // totals of samples are from lengths
  if (form_ == ProgressForm::kOff) return;
  const auto now = Clock::now();
  const auto pause = std::chrono::milliseconds(form_ == ProgressForm::kJson ? 1000 : 100);
  if (now - drawn_ < pause && done_ != total_) return;
  if (quiet_secs_ > 0 && secs() < quiet_secs_) return;
  drawn_ = now;
  drawn_done_ = done_;
  if (form_ == ProgressForm::kJson) {
    PrintJson();
  } else {
    Draw();
  }
}

void Progress::Skip() {
  if (total_ > done_) --total_;
}

void Progress::Draw() const {
  const double rate = done_ / secs();
  if (total_ > 0) {
    std::fprintf(stderr, "\r%s %d of %d, %.0f per second, %.0f s left   ", what_.c_str(), done_,
                 total_, rate, (total_ - done_) / rate);
  } else {
    std::fprintf(stderr, "\r%s %d, %.0f per second   ", what_.c_str(), done_, rate);
  }
}

// One write: several processes may share the stream.
void Progress::PrintJson() const {
  const double spent = secs();
  nlohmann::ordered_json line = {{"progress", what_.substr(0, what_.find_last_not_of(':') + 1)},
                                 {"done", done_},
                                 {"seconds", Thousandths(spent)}};
  if (total_ > 0) {
    line["total"] = total_;
    line["seconds_left"] = Thousandths(spent / done_ * (total_ - done_));
  }
  const std::string text = JsonText(line) + '\n';
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace kinescope::app
