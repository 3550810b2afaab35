/// The log of the program: one line per message on standard error.
#pragma once

#include <spdlog/logger.h>
#include <spdlog/sinks/base_sink.h>

#include <cstddef>
#include <deque>
#include <mutex>
#include <string>

namespace kinescope::app {

/// Names in messages are untrusted: control characters and line breaks become U+FFFD.
void MakeLinesPrintable(spdlog::logger& log);

struct LogLine {
  spdlog::level::level_enum level = spdlog::level::info;
  std::string text;  // without control characters
};

/// Keeps the newest lines for a reader that is not there yet, /rosout for example. Any thread.
class LogTail : public spdlog::sinks::base_sink<std::mutex> {
 public:
  static constexpr std::size_t kMost = 200;

  /// The lines since the last call.
  std::deque<LogLine> Take();

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

 private:
  std::deque<LogLine> lines_;  // guarded by mutex_
};

}  // namespace kinescope::app
