#include "server/app/log.h"

#include <spdlog/details/log_msg.h>
#include <spdlog/pattern_formatter.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "core/system/utf8.h"

namespace kinescope::app {
namespace {

class PrintableFormatter : public spdlog::formatter {
 public:
  PrintableFormatter() : pattern_("%H:%M:%S.%e %^%l%$: %v") {}

  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& line) override {
    const std::string text =
        PrintableLine(std::string_view(message.payload.data(), message.payload.size()));
    spdlog::details::log_msg printable = message;
    printable.payload = text;
    pattern_.format(printable, line);
    message.color_range_start = printable.color_range_start;
    message.color_range_end = printable.color_range_end;
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<PrintableFormatter>();
  }

 private:
  spdlog::pattern_formatter pattern_;
};

}  // namespace

std::deque<LogLine> LogTail::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(lines_, {});
}

void LogTail::sink_it_(const spdlog::details::log_msg& message) {
  const std::string_view text(message.payload.data(), message.payload.size());
  lines_.push_back({message.level, PrintableLine(text)});
  if (lines_.size() > kMost) lines_.pop_front();
}

void MakeLinesPrintable(spdlog::logger& log) {
  log.set_formatter(std::make_unique<PrintableFormatter>());
}

}  // namespace kinescope::app
