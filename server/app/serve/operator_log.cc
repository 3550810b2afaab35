#include "server/app/serve/operator_log.h"

#include <spdlog/spdlog.h>

namespace kinescope::app {

marks::Moment OperatorLog::Now() const {
  const auto state = states_.Get();
  if (state == nullptr || state->stamp_nanos == 0) return {};
  return {state->number, state->made_nanos, state->stamp_nanos, state->time_code_millis,
          state->counter};
}

void OperatorLog::Note(std::string_view role, const std::string& what, const std::string& before,
                       const std::string& after, const marks::Moment& at) {
  if (before == after) return;
  spdlog::info("{} changed {}: {} → {}", role, what, before, after);
  marks::NewMark mark;
  mark.text = what + ": " + before + " → " + after;
  mark.role = role;
  mark.kind = marks::Kind::kChange;
  mark.at = at;
  Add(mark);
}

std::optional<std::uint64_t> OperatorLog::BeginTrial(std::string_view role,
                                                     const std::string& title,
                                                     const marks::Moment& at) {
  marks::NewMark mark;
  mark.text = title;
  mark.role = role;
  mark.is_span = true;
  mark.kind = marks::Kind::kTrial;
  mark.at = at;
  return Add(mark);
}

void OperatorLog::EndTrial(std::uint64_t id, const marks::Moment& at) {
  if (book_ == nullptr) return;
  const auto ended = book_->End(id, at);
  if (!ended) spdlog::warn("the mark of the trial was not ended: {}", ended.error());
}

std::optional<std::uint64_t> OperatorLog::Add(const marks::NewMark& mark) {
  if (book_ == nullptr) return std::nullopt;
  const auto kept = book_->Add(mark);
  if (kept) return kept->id;
  spdlog::warn("“{}” was not marked: {}", mark.text, kept.error());
  return std::nullopt;
}

}  // namespace kinescope::app
