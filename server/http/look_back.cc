#include "server/http/look_back.h"

#include <algorithm>
#include <utility>

#include "core/system/check.h"
#include "server/history/chunk.h"

namespace kinescope::http {
namespace {

constexpr std::size_t kStatesPerDetails = 16;

// Decides which states of a run come with details.
class RunDetails {
 public:
  explicit RunDetails(const DetailsOfState& details) : details_(details) {}

  // "": those of the state before.
  std::string For(const SceneState& state) {
    const bool is_other = number_ == 0 || !history::SameForm(last_, state) ||
                          last_.surroundings != state.surroundings;
    const bool is_due = is_other || number_ % kStatesPerDetails == 0;
    ++number_;
    if (is_other) last_ = state;
    if (!is_due) return {};
    std::string text = details_(state);
    if (text == text_) return {};
    text_ = text;
    return text;
  }

 private:
  const DetailsOfState& details_;
  std::size_t number_ = 0;
  SceneState last_;  // with whose people and objects text_ was made
  std::string text_;
};

}  // namespace

std::optional<PastAnswer> AnswerLookBack(const LookBack& wanted, std::size_t most,
                                         const history::History& history,
                                         const DetailsOfState& details, const StateMoment& moment) {
  KINESCOPE_CHECK(most >= 1 && most <= kMaxPastStates);
  PastEncoder encoder(wanted.id, moment);
  if (wanted.number) {
    const auto state = history.Numbered(*wanted.number);
    if (state == nullptr) return std::nullopt;
    encoder.Add(*state, details(*state));
    return PastAnswer{encoder.Finish(state->made_nanos), 1};
  }
  const auto kept = history.extent();
  if (!kept) return std::nullopt;
  history::Span span = wanted.span;
  span.from_nanos = std::max(span.from_nanos, kept->first_nanos);
  span.until_nanos = std::min(span.until_nanos, span.from_nanos + kMaxPastNanos);
  RunDetails run_details(details);
  const auto until = history.Visit(span, [&](const SceneState& state) {
    encoder.Add(state, run_details.For(state));
    return encoder.count() < most && encoder.bytes() < kMaxPastBytes;
  });
  if (!until) return std::nullopt;
  const std::size_t states = encoder.count();
  return PastAnswer{encoder.Finish(*until), states};
}

}  // namespace kinescope::http
