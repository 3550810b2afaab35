#include "server/http/hub.h"

#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "server/http/answer.h"
#include "server/http/api.h"
#include "server/http/look_back.h"

namespace kinescope::http {
namespace {

SharedBytes Share(Bytes bytes) { return std::make_shared<const Bytes>(std::move(bytes)); }

}  // namespace

Hub::Hub(const Latest<SceneState>& states, const Latest<Picture>& pictures, PictureFeed* feed,
         const history::History* history, std::string camera, Counters& counters,
         GetPlayback playback, const marks::MarkBook* marks)
    : states_(states),
      pictures_(pictures),
      feed_(feed),
      history_(history),
      camera_(std::move(camera)),
      counters_(counters),
      playback_(std::move(playback)),
      marks_(marks) {}

int Hub::CountOf(const std::string& address) const {
  return static_cast<int>(std::count_if(clients_.begin(), clients_.end(), [&](const auto& each) {
    return each.first->address() == address;
  }));
}

bool Hub::HasPlaceFor(const std::string& address) const {
  return CountOf(address) < kMaxClients - client_count_;
}

std::string Hub::WhyNoPlaceFor(const std::string& address) const {
  return "too many clients: " + std::to_string(CountOf(address)) + " WebSockets of " + address +
         " are open, and " + std::to_string(client_count_) + " of " + std::to_string(kMaxClients) +
         " in all; an address may have as many as there are free places. Close other pages, or "
         "try again later";
}

bool Hub::Join(HubClient& client) {
  if (!HasPlaceFor(client.address())) return false;
  clients_.try_emplace(&client);
  client_count_ = static_cast<int>(clients_.size());
  ++counters_.opened;
  client.Offer(Slot::kDetails, EncodeDetails());
  client.Offer(Slot::kState, EncodeNewestState());
  for (const auto& [slot, message] : news_) client.Offer(slot, message);
  return true;
}

void Hub::Leave(HubClient& client) {
  if (clients_.erase(&client) == 0) return;
  client_count_ = static_cast<int>(clients_.size());
  const ClientCounters gone = client.counters();
  counters_.closed.states_sent += gone.states_sent;
  counters_.closed.states_dropped += gone.states_dropped;
  counters_.closed.pictures_sent += gone.pictures_sent;
  counters_.closed.pictures_dropped += gone.pictures_dropped;
  CountViewers();
}

Hub::Clock::duration Hub::SendState(Clock::time_point now) {
  if (clients_.empty()) return Clock::duration::zero();
  const Clock::duration wait = state_sent_at_ + kMinStateInterval - now;
  if (wait > Clock::duration::zero()) return wait;
  state_sent_at_ = now;
  const SharedBytes message = EncodeNewestState();
  ++counters_.states_encoded;
  const bool also_few = now - few_sent_at_ >= kFewInterval;
  if (also_few) few_sent_at_ = now;
  for (const auto& [client, seat] : clients_) {
    if (also_few || !seat.few_states) client->Offer(Slot::kState, message);
  }
  return Clock::duration::zero();
}

void Hub::SendPicture() {
  const std::shared_ptr<const Picture> picture = pictures_.Get();
  if (viewers_ == 0 || picture == nullptr) return;
  picture_ = Share(EncodePicture(*picture));
  ++counters_.pictures_encoded;
  for (const auto& [client, seat] : clients_) {
    if (client->wants_pictures()) client->Offer(Slot::kPicture, picture_);
  }
}

void Hub::Tick(Clock::time_point now) {
  if (clients_.empty()) return;
  if (now - state_sent_at_ >= kHeartbeat) SendState(now);
  SharedBytes details = EncodeDetails();
  if (details_ != nullptr && *details == *details_) return;
  details_ = std::move(details);
  for (const auto& [client, seat] : clients_) client->Offer(Slot::kDetails, details_);
}

void Hub::SendNews(Slot slot, const std::string& news) {
  if (news.empty()) return;
  const char* const name = slot == Slot::kAlarms     ? "alarms"
                           : slot == Slot::kControls ? "controls"
                                                     : "stream";
  const std::string text = "{\"" + std::string(name) + "\":" + news + "}";
  Bytes message(text.begin(), text.end());
  SharedBytes& last = news_[slot];
  if (last != nullptr && *last == message) return;
  last = Share(std::move(message));
  for (const auto& [client, seat] : clients_) client->Offer(slot, last);
}

void Hub::OnMessage(HubClient& client, std::string_view text) {
  const auto command = ParseCommand(text);
  if (!command) {
    ++counters_.rejected["bad message"];
    return client.Offer(Slot::kError, Share(EncodeError(command.error())));
  }
  if (!MayAct(client.role(), command->least)) {
    ++counters_.rejected["not an operator"];
    const std::string why = WhyNotPermitted('"' + command->needs_least + '"', client.role());
    return client.Offer(Slot::kError, Share(EncodeError(why)));
  }
  if ((command->seen_states && !client.OnSeen(Slot::kState, *command->seen_states)) ||
      (command->seen_pictures && !client.OnSeen(Slot::kPicture, *command->seen_pictures))) {
    ++counters_.rejected["bad message"];
    return client.Offer(
        Slot::kError,
        Share(EncodeError("seen_states or seen_pictures is larger than the number sent")));
  }
  if (command->dark) client.SetWantsDark(*command->dark);
  if (command->pictures) SetPictures(client, *command->pictures);
  if (command->dark) ChooseTheme();
  if (command->camera) {
    const std::string why = SelectCamera(*command->camera, Name(client.role()));
    if (!why.empty()) client.Offer(Slot::kError, Share(EncodeError(why)));
  }
  if (command->few_states) SetFewStates(client, *command->few_states);
  if (command->look) LookBack(client, *command->look);
  if (command->ping) client.Offer(Slot::kPong, Share(EncodePong(*command->ping, MonotonicNanos())));
}

std::string Hub::SelectCamera(const std::string& camera, std::string_view role) {
  if (feed_ == nullptr || !feed_->SetCamera(camera)) {
    ++counters_.rejected[feed_ == nullptr ? "no renderer" : "unknown camera"];
    return feed_ == nullptr ? kNoRenderer : "unknown camera " + camera;
  }
  const std::string before = std::exchange(camera_, camera);
  if (on_camera_ && before != camera) on_camera_(before, camera, role);
  return "";
}

// At once all states again: the one that the client has may be old.
void Hub::SetFewStates(HubClient& client, bool few) {
  const auto found = clients_.find(&client);
  if (found == clients_.end()) return;
  if (std::exchange(found->second.few_states, few) && !few) {
    client.Offer(Slot::kState, EncodeNewestState());
  }
}

void Hub::LookBack(HubClient& client, const struct LookBack& wanted) {
  const auto found = clients_.find(&client);
  if (found == clients_.end()) return;
  Bucket& budget = found->second.past_states;
  const auto now = Clock::now();
  std::size_t most = kMaxPastStates;
  while (most > 1 && budget.WaitFor(static_cast<double>(most), now).count() > 0) most /= 2;
  std::optional<PastAnswer> answer;
  if (history_ != nullptr) {
    const auto details = [&](const SceneState& state) {
      return DetailsOf(&state, state.surroundings);
    };
    answer = AnswerLookBack(wanted, most, *history_, details, Moment());
  }
  if (!answer) {
    ++counters_.rejected["no history"];
    return client.Offer(Slot::kError, Share(EncodeError(kNoHistory)));
  }
  budget.Take(static_cast<double>(answer->states), now);
  counters_.past_states_encoded += answer->states;
  client.Offer(Slot::kPast, Share(std::move(answer->message)));
}

StateMoment Hub::Moment() const {
  StateMoment moment{MonotonicNanos(), client_count(), {}};
  if (history_ != nullptr) moment.kept = history_->extent();
  return moment;
}

void Hub::SetPictures(HubClient& client, bool wanted) {
  if (client.wants_pictures() == wanted) return;
  client.SetWantsPictures(wanted);
  CountViewers();
  if (wanted && picture_ != nullptr) client.Offer(Slot::kPicture, picture_);
}

// All share one picture: it is dark while no viewer has a light page.
void Hub::ChooseTheme() {
  const auto watches = [](const auto& each) { return each.first->wants_pictures(); };
  const auto is_light = [&](const auto& each) {
    return watches(each) && !each.first->wants_dark();
  };
  const bool is_dark = std::any_of(clients_.begin(), clients_.end(), watches) &&
                       std::none_of(clients_.begin(), clients_.end(), is_light);
  if (is_dark == is_dark_) return;
  is_dark_ = is_dark;
  if (feed_ != nullptr) feed_->SetDark(is_dark);
}

void Hub::CountViewers() {
  ChooseTheme();
  const int viewers =
      static_cast<int>(std::count_if(clients_.begin(), clients_.end(), [](const auto& each) {
        return each.first->wants_pictures();
      }));
  if (viewers == viewers_) return;
  viewers_ = viewers;
  if (viewers == 0) picture_ = nullptr;  // without viewers it would grow old
  if (feed_ != nullptr) feed_->SetViewers(viewers);
}

std::vector<ClientCounters> Hub::client_counters() const {
  std::vector<ClientCounters> all;
  for (const auto& [client, seat] : clients_) all.push_back(client->counters());
  return all;
}

SharedBytes Hub::EncodeNewestState() const {
  static const SceneState kNothing;
  const std::shared_ptr<const SceneState> state = states_.Get();
  return Share(EncodeState(state != nullptr ? *state : kNothing, Moment()));
}

SharedBytes Hub::EncodeDetails() const {
  const std::shared_ptr<const SceneState> state = states_.Get();
  const auto surroundings = surroundings_ ? surroundings_() : nullptr;
  const bool has_any = state != nullptr && state->surroundings != 0 && surroundings != nullptr;
  const std::string text = DetailsOf(state.get(), has_any ? surroundings->revision : 0);
  return Share(Bytes(text.begin(), text.end()));
}

std::string Hub::DetailsOf(const SceneState* state, std::uint64_t surroundings) const {
  DetailsExtras extras;
  extras.playback = playback_ ? playback_() : nullptr;
  if (marks_ != nullptr && history_ != nullptr) extras.marks_revision = marks_->revision();
  if (surroundings != 0) extras.surroundings = surroundings;
  return DetailsJson(state, camera_, feed_ != nullptr, extras);
}

}  // namespace kinescope::http
