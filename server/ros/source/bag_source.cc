#include "server/ros/source/bag_source.h"

#include <ros/message_traits.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <tf2_msgs/TFMessage.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/near_whole.h"
#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "core/system/words.h"
#include "server/ros/frame_ways.h"
#include "server/ros/names.h"
#include "server/ros/raw_message.h"
#include "server/ros/source/bag_messages.h"
#include "server/ros/source/bag_surroundings.h"
#include "server/ros/source/common_frame.h"
#include "server/ros/source/link_states_person.h"
#include "server/ros/source/motion_joiner.h"
#include "server/ros/source/recorded_loads.h"
#include "server/ros/source/told_people.h"
#include "server/ros/source/transform_people.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

constexpr int kMessagesPerPoll = 256;
constexpr std::int64_t kNamesNanos = 10'000'000'000;  // read on opening for frame names

constexpr char kUnreadableTransforms[] =
    "transforms that are truncated or have a wrong length field";
constexpr char kUnreadablePeople[] =
    "kinescope/PersonArray that is truncated or has a wrong length field";
constexpr char kUnreadableLinkStates[] =
    "message of link states that is truncated or has a wrong length field";
constexpr char kOtherType[] = "message on the topic of transforms that is not a TFMessage";

bool HasTransformType(const BagConnection& connection) {
  // tf/tfMessage in old recordings is the same message with another name.
  return connection.md5sum == ros::message_traits::md5sum<tf2_msgs::TFMessage>();
}
bool IsLinkStates(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<xsens_mvn_ros_msgs::LinkStateArray>();
}

// When something appeared, as far as its rate needs.
class Appearances {
 public:
  void Add(std::int64_t now) {
    constexpr std::size_t kMost = 4096;
    if (last_nanos_ && now > *last_nanos_ && steps_.size() < kMost) {
      steps_.push_back(now - *last_nanos_);
    }
    last_nanos_ = now;
  }
  // Of the steps that are no pause; 0: unknown.
  double rate_hz() const {
    if (steps_.empty()) return 0;
    std::vector<std::int64_t> sorted = steps_;
    std::sort(sorted.begin(), sorted.end());
    const std::int64_t longest = std::max(kNanosPerSecond, 4 * sorted[sorted.size() / 2]);
    const auto end = std::upper_bound(sorted.begin(), sorted.end(), longest);
    const std::int64_t sum = std::accumulate(sorted.begin(), end, std::int64_t{0});
    return NearWhole(static_cast<double>(end - sorted.begin()) / Secs(sum));
  }

 private:
  std::vector<std::int64_t> steps_;
  std::optional<std::int64_t> last_nanos_;
};

// Passes everything on, and knows the times of the newest samples.
class SampleWatch : public SampleSink {
 public:
  using Bring = std::function<void(BodySample& sample)>;

  /// `bring`: to the frame of the scene.
  explicit SampleWatch(Bring bring) : bring_(std::move(bring)) {}

  void SetSink(SampleSink* sink) { sink_ = sink; }
  std::int64_t newest_nanos() const { return newest_nanos_; }
  std::int64_t step_nanos() const { return step_nanos_; }  // from the one before; 0: was none

  void OnCharacter(const Character& character) override { sink_->OnCharacter(character); }
  void OnSample(const BodySample& sample) override {
    const std::int64_t before = std::exchange(newest_nanos_, sample.stamp_nanos);
    step_nanos_ = before == 0 ? 0 : newest_nanos_ - before;
    BodySample brought = sample;
    bring_(brought);
    sink_->OnSample(brought);
  }
  void OnSurroundings(const RecordedSurroundings& all) override { sink_->OnSurroundings(all); }
  void OnMoment(const SourceMoment& moment) override { sink_->OnMoment(moment); }

 private:
  const Bring bring_;
  SampleSink* sink_ = nullptr;
  std::int64_t newest_nanos_ = 0;  // 0: there was none
  std::int64_t step_nanos_ = 0;
};

// "" if all could be read.
std::string DamageIn(const BagMessages& messages) {
  std::uint64_t count = 0;
  std::vector<std::string> kinds;
  std::string harmless;
  for (const auto& [defect, records] : messages.defects()) {
    const std::string kind = fmt::format("{}: {}", defect, records);
    if (defect == BagReader::kOtherLength) {
      harmless = kind;
      continue;
    }
    count += records;
    kinds.push_back(kind);
  }
  if (count == 0) return harmless;
  return fmt::format("{} left out ({}){}{}",
                     Counted(count, "damaged record was", "damaged records were"),
                     fmt::join(kinds, ", "), harmless.empty() ? "" : "; ", harmless);
}

class BagSource : public Source {
 public:
  BagSource(const std::string& path, const GraphView& view)
      : name_(path),
        tf_topic_(view.tf_topic.empty() ? "/tf" : WithSlash(view.tf_topic)),
        has_chosen_tf_(!view.tf_topic.empty()),
        needs_person_(view.needs_person),
        surroundings_(view),
        messages_(OpenBagFile(path),
                  [this](const BagConnection& connection) { return IsUsed(connection); }),
        common_frame_(fmt::format("bag '{}'", path), ""),
        watch_([this](BodySample& sample) {
          common_frame_.Bring(sample, people_.RootOf(sample.character), world_);
        }) {
    joiner_.SetSink(&watch_);
    ReadNames();
    world_ = has_person_ ? FindWorld() : FindRoot();
  }

  // A picture may need the beginning of the bag alone, so the end is too late to say it.
  ~BagSource() override {
    if (counters_.samples > 0 || moment_nanos_ != 0) surroundings_.WarnOfProblems(name_, world_);
    const bool has_own = counters_.ignored.count(BagSurroundings::kOwnMarkers) > 0;
    if (!has_person_ && has_own && surroundings_.IsEmpty()) {
      WarnOfBag(name_, fmt::format("has no person on {} or link_states, and its markers are those "
                                   "of a Kinescope, which are drawn with the person only",
                                   tf_topic_));
    }
    const std::string damage = DamageIn(messages_);
    if (!has_ended_ && !damage.empty()) WarnOfBag(name_, damage);
  }
  BagSource(const BagSource&) = delete;
  BagSource& operator=(const BagSource&) = delete;

  State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override;

  SourceCounters counters() const override;
  std::string description() const override { return name_; }
  bool is_live() const override { return false; }
  double nominal_rate_hz() const override { return rate_hz_; }

 private:
  bool IsMoving(const std::string& topic) const { return WithSlash(topic) == tf_topic_; }
  bool IsStatic(const std::string& topic) const {
    const std::string name = WithSlash(topic);
    return name == "/tf_static" || name == tf_topic_ + "_static";
  }
  bool HasTransforms(const BagConnection& connection) const {
    return IsMoving(connection.topic) || IsStatic(connection.topic);
  }
  bool IsUsed(const BagConnection& connection) const {
    return HasTransforms(connection) || IsLinkStates(connection) ||
           RecordedLoads::IsOne(connection) || IsOfPeople(connection) ||
           surroundings_.IsUsed(connection);
  }

  static bool IsOfPeople(const BagConnection& connection) {
    return Is<kinescope_ros::PersonArray>(connection.md5sum);
  }
  ToldPeople::Key KeyOf(int character) const;

  void ReadNames();
  /// The frame of the first sample, in which markers stand from the beginning; "" if none comes
  /// soon. @pre people_ are known
  std::string FindWorld();
  /// Gives the messages of transforms of the first seconds to `take`, in message_, until it returns
  /// false.
  void ReadTransforms(const std::function<bool(const BagMessage& message)>& take);
  /// Of a bag without people: the root of its frames; "" if it has none, then it is the frame of
  /// what is shown first.
  std::string FindRoot();
  bool ShowsSomething(const BagMessages& all) const;
  /// @throws SourceError unless the bag ends as it should, or is only truncated.
  void CheckEnding(const BagMessages& messages) const;
  /// Of one whose next record cannot be found.
  std::string WhyDamaged(const BagMessages& messages) const;
  /// Why nothing of `message` can be used, or null; otherwise it is in message_.
  const char* Decode(const BagMessage& message);
  void Take(const BagMessage& message);
  void TakeLinkStates(const BagMessage& message);
  void TakePeople(const BagMessage& message);
  void PassMoment(std::int64_t now_nanos, std::int64_t stamp_nanos);
  void PassMomentNow(std::int64_t now_nanos, std::int64_t stamp_nanos);
  void PassMomentOrLater(std::int64_t now_nanos);
  void PassLateMoment();
  /// Moments go on when no sample comes, if something else is shown.
  void PassMomentWithoutPeople(std::int64_t now_nanos);
  State End();
  void WarnOfUnused() const;

  /// Why the bag has no person, and what to do about it.
  std::string WhyNobody(const BagMessages& all) const;
  void WarnOfMissingTransforms(const BagMessages& all) const;
  bool HasMoving(const BagMessages& all) const;
  /// The topics of transforms beside those that are read.
  std::set<std::string> OtherTransforms(const BagMessages& all) const;

  const std::string name_;
  const std::string tf_topic_;
  const bool has_chosen_tf_;  // else it is the usual topic
  const bool needs_person_;
  bool has_person_ = true;
  BagSurroundings surroundings_;
  BagMessages messages_;
  tf2_msgs::TFMessage message_;
  xsens_mvn_ros_msgs::LinkStateArray link_states_;
  TransformPeople people_{0};
  MotionJoiner joiner_;
  RecordedLoads recorded_loads_;
  ToldPeople told_people_{[this](int character) { return KeyOf(character); }};
  CommonFrame common_frame_;
  SampleWatch watch_;                              // what is delivered goes through it
  std::map<std::string, LinkStatesPerson> links_;  // by topic; empty if there are people on /tf
  SampleOrigin origin_;                            // of `links_`
  std::string world_;
  std::int64_t moment_nanos_ = 0;       // of the newest moment that was passed on; 0: none was
  std::int64_t late_moment_nanos_ = 0;  // of a bag without people: of one that came too soon
  std::int64_t person_nanos_ = 0;       // when the message of the newest sample was recorded
  bool has_ended_ = false;
  SourceCounters counters_;
  double rate_hz_ = 0;
};

SourceError ErrorIn(const std::string& name, const std::string& what) {
  return SourceError("bag '" + name + "': " + what);
}

void BagSource::ReadNames() {
  BagMessages ahead(OpenBagFile(name_), [this](const BagConnection& connection) {
    return HasTransforms(connection) || IsLinkStates(connection) || IsOfPeople(connection);
  });
  std::map<std::string, Appearances> appearances, of_link_states;
  std::int64_t end = 0;
  ToldWhenTheyCame told;
  bool has_ended = true;
  BagMessage message;
  while (ahead.Next(message)) {
    const std::int64_t now = message.recorded_nanos;
    if (end == 0) end = now + kNamesNanos;
    if (now > end && people_.people().empty()) {
      people_.FindPeople();
      if (!people_.people().empty()) end = now + ToldWhenTheyCame::kJustNanos;
    }
    if (now > end && !people_.people().empty()) {
      has_ended = false;
      break;
    }
    if (IsOfPeople(*message.connection)) {
      told.Find(message.bytes, now, told_people_);  // it is counted when its turn comes
      continue;
    }
    if (IsLinkStates(*message.connection)) {
      of_link_states[message.connection->topic].Add(now);
      told.OnPose(NamespaceOf(WithSlash(message.connection->topic)), now);
      continue;
    }
    if (Decode(message) != nullptr) continue;
    for (const geometry_msgs::TransformStamped& transform : message_.transforms) {
      if (!people_.AddName(transform.child_frame_id)) continue;
      told.OnPose(WithoutSlash(transform.child_frame_id), now);
      const std::int64_t header = ToNanos(transform.header.stamp);
      appearances[WithoutSlash(transform.child_frame_id)].Add(IsOfRecordTime(header, now) ? header
                                                                                          : now);
    }
  }
  people_.FindPeople();
  if (ShowsSomething(ahead)) surroundings_.Expect();
  if (!of_link_states.empty()) joiner_.Expect();
  if (people_.people().empty() && !of_link_states.empty()) {
    for (const auto& [topic, appearance] : of_link_states) {
      links_.try_emplace(topic, OwnerOfTopic(topic), static_cast<int>(links_.size()));
    }
    rate_hz_ = of_link_states.begin()->second.rate_hz();
    WarnOfMissingTransforms(ahead);
    return;
  }
  if (people_.people().empty() && !needs_person_ && ShowsSomething(ahead)) {
    has_person_ = false;
    return;
  }
  if (people_.people().empty()) {
    if (has_ended) CheckEnding(ahead);
    if (ahead.ending().kind == BagReader::Ending::Kind::kTruncated && has_ended) {
      throw ErrorIn(name_, fmt::format("was not closed or is truncated, and has no person on {} in "
                                       "its {} complete messages; record or copy it again",
                                       tf_topic_, ahead.read()));
    }
    throw ErrorIn(name_, WhyNobody(ahead));
  }
  rate_hz_ = appearances[people_.people().front().frames[urdf::kPelvis]].rate_hz();
}

bool BagSource::ShowsSomething(const BagMessages& all) const {
  return std::any_of(all.connections().begin(), all.connections().end(), [&](const auto& each) {
    const BagConnection& connection = each.second;
    return surroundings_.IsUsed(connection) ||
           (surroundings_.ShowsFrames() && HasTransforms(connection) &&
            HasTransformType(connection));
  });
}

bool BagSource::HasMoving(const BagMessages& all) const {
  return std::any_of(all.connections().begin(), all.connections().end(),
                     [&](const auto& each) { return IsMoving(each.second.topic); });
}

std::set<std::string> BagSource::OtherTransforms(const BagMessages& all) const {
  std::set<std::string> others;
  for (const auto& [number, connection] : all.connections()) {
    const bool is_wanted = IsMoving(connection.topic) || IsStatic(connection.topic);
    if (HasTransformType(connection) && !is_wanted) others.insert(connection.topic);
  }
  return others;
}

// The people come from link states, which have no frames of others.
void BagSource::WarnOfMissingTransforms(const BagMessages& all) const {
  const std::set<std::string> others = OtherTransforms(all);
  if (HasMoving(all) || (!has_chosen_tf_ && others.empty())) return;
  WarnOfBag(
      name_,
      fmt::format(
          "has no transforms on {} (--tf_topic){}: people are those of its link states", tf_topic_,
          others.empty() ? "" : fmt::format("; it has some on {}", fmt::join(others, ", "))));
}

std::string BagSource::WhyNobody(const BagMessages& all) const {
  std::set<std::string> shown;
  for (const auto& [number, connection] : all.connections()) {
    if (BagSurroundings::CanBeShown(connection)) shown.insert(WithSlash(connection.topic));
  }
  const std::set<std::string> others = OtherTransforms(all);
  const bool has_topic = HasMoving(all);
  std::string why =
      has_topic ? fmt::format(
                      "no person found on {}; expected 23 frames with segment names, such "
                      "as skeleton_pelvis, skeleton_l5, ..., skeleton_left_toe",
                      tf_topic_)
                : fmt::format("contains neither {} nor link_states, so no poses", tf_topic_);
  if (!others.empty()) {
    why += fmt::format(". It has transforms on {}: choose {} with --tf_topic",
                       fmt::join(others, ", "), others.size() == 1 ? "that" : "one of these");
  } else if (!has_topic) {
    why += "; record it with `rosbag record /tf`";
  }
  if (!needs_person_ && surroundings_.HasTopics()) {
    why += ". None of the topics that are named is in it, as one that can be shown";
  }
  if (!needs_person_ && !shown.empty()) {
    why += fmt::format(". What else is in it is shown if you name it: --marker_topics={}",
                       fmt::join(shown, ","));
  }
  if (const std::string damage = DamageIn(all); !damage.empty()) why += ". " + damage;
  return why;
}

std::string BagSource::FindWorld() {
  if (!links_.empty()) return "world";  // the messages do not say it
  struct : SampleSink {
    void OnCharacter(const Character&) override {}
    void OnSample(const BodySample&) override {}
  } nothing;
  TransformPeople people = people_;
  SourceCounters unused;
  ReadTransforms([&](const BagMessage& message) {
    if (IsStatic(message.connection->topic)) {
      people.TakeStatic(message_, unused);
    } else {
      people.Take(message_, {message.recorded_nanos, 0}, unused, nothing);
    }
    return people.root().empty();
  });
  return people.root();
}

void BagSource::ReadTransforms(const std::function<bool(const BagMessage& message)>& take) {
  BagMessages ahead(OpenBagFile(name_),
                    [this](const BagConnection& connection) { return HasTransforms(connection); });
  std::int64_t end = 0;
  for (BagMessage message; ahead.Next(message);) {
    if (end == 0) end = message.recorded_nanos + kNamesNanos;
    if (message.recorded_nanos > end) return;
    if (Decode(message) == nullptr && !take(message)) return;
  }
}

std::string BagSource::FindRoot() {
  TfTree tf;
  ReadTransforms([&](const BagMessage& message) {
    tf.Add(message_, IsStatic(message.connection->topic));
    return true;
  });
  return RootOf(tf.frames(), "");
}

std::string BagSource::WhyDamaged(const BagMessages& messages) const {
  return fmt::format(
      "bag '{}' is damaged after {} messages ({}), and what follows is not read; `rosbag reindex` "
      "may repair it",
      name_, messages.read(), messages.ending().reason);
}

void BagSource::CheckEnding(const BagMessages& messages) const {
  const BagReader::Ending& ending = messages.ending();
  switch (ending.kind) {
    case BagReader::Ending::Kind::kClosed:
    case BagReader::Ending::Kind::kTruncated: return;
    case BagReader::Ending::Kind::kDamaged: throw SourceError(WhyDamaged(messages));
    case BagReader::Ending::Kind::kUnreadable:
      throw ErrorIn(name_, fmt::format("cannot be read after {} messages ({}); copy it again from "
                                       "its origin",
                                       messages.read(), ending.reason));
    case BagReader::Ending::Kind::kEncrypted:
      throw ErrorIn(name_, "is encrypted; decrypt it with `rosbag decrypt`");
  }
}

Source::State BagSource::Poll(std::chrono::milliseconds /*timeout*/, SampleSink& sink) {
  if (has_ended_) return State::kEnded;
  watch_.SetSink(&sink);
  const std::uint64_t samples_before = counters_.samples;
  const std::int64_t moment_before = moment_nanos_;
  BagMessage message;
  for (int i = 0; i < kMessagesPerPoll && counters_.samples == samples_before &&
                  moment_nanos_ == moment_before;
       ++i) {
    if (!messages_.Next(message)) {
      joiner_.Flush();
      PassLateMoment();
      return End();
    }
    const std::int64_t last = moment_nanos_ == 0 ? late_moment_nanos_ : moment_nanos_;
    if (message.recorded_nanos - last >= kPlaceEveryNanos) PassLateMoment();
    Take(message);
    if (!has_person_) {
      PassMomentOrLater(message.recorded_nanos);
    } else if (counters_.samples != samples_before) {
      person_nanos_ = message.recorded_nanos;
    } else {
      PassMomentWithoutPeople(message.recorded_nanos);
    }
  }
  return State::kMore;
}

Source::State BagSource::End() {
  has_ended_ = true;
  people_.End(counters_);
  WarnOfUnused();
  // Else they have what was told.
  const std::vector<std::string> texts =
      told_people_.is_empty() ? recorded_loads_.Texts() : std::vector<std::string>();
  for (const std::string& text : texts) {
    spdlog::info("bag '{}': {}; those of its motion are computed with --mass and --hand_load",
                 name_, text);
  }
  const BagReader::Ending& ending = messages_.ending();
  if (ending.kind == BagReader::Ending::Kind::kDamaged && messages_.read() > 0) {
    spdlog::warn("{}", WhyDamaged(messages_));
    return State::kEnded;
  }
  CheckEnding(messages_);
  if (ending.kind == BagReader::Ending::Kind::kTruncated) {
    spdlog::warn(
        "bag '{}' was not closed or is truncated (the recorder was probably killed); {} complete "
        "messages were read",
        name_, messages_.read());
  } else if (const std::string damage = DamageIn(messages_); !damage.empty()) {
    WarnOfBag(name_, damage);
  }
  return State::kEnded;
}

// What stands in the scene names its own.
void BagSource::WarnOfUnused() const {
  std::vector<std::string> kinds;
  for (const auto& [defect, count] : counters_.rejected) {
    if (surroundings_.HasNamed(defect)) continue;
    kinds.push_back(fmt::format("{}: {}", defect, count));
  }
  if (!kinds.empty()) WarnOfBag(name_, fmt::format("not used: {}", fmt::join(kinds, ", ")));
}

void BagSource::Take(const BagMessage& message) {
  if (RecordedLoads::IsOne(*message.connection)) return recorded_loads_.Take(message);
  if (IsOfPeople(*message.connection)) return TakePeople(message);
  ++counters_.datagrams;
  counters_.bytes += message.size;
  if (IsLinkStates(*message.connection)) return TakeLinkStates(message);
  if (!HasTransforms(*message.connection)) return surroundings_.Take(message, counters_);
  if (const char* const defect = Decode(message)) {
    ++counters_.rejected[defect];
    return;
  }
  const bool is_static = IsStatic(message.connection->topic);
  surroundings_.AddTransforms(message_, message.connection->topic, is_static);
  common_frame_.Take(message_, is_static);
  if (is_static) {
    people_.TakeStatic(message_, counters_);
  } else {
    // Without people, with the moments.
    if (has_person_) surroundings_.Update(message.recorded_nanos, world_, name_, joiner_);
    told_people_.SetSink(&joiner_);
    people_.Take(message_, {message.recorded_nanos, 0}, counters_, told_people_);
  }
}

void BagSource::PassMoment(std::int64_t now_nanos, std::int64_t stamp_nanos) {
  const bool is_soon = moment_nanos_ != 0 && now_nanos - moment_nanos_ < kPlaceEveryNanos;
  if (!is_soon) PassMomentNow(now_nanos, stamp_nanos);
}

// Of a bag without people. With the first message others come: a recorder begins with what is
// latched.
void BagSource::PassMomentOrLater(std::int64_t now_nanos) {
  const bool is_soon = moment_nanos_ == 0 || now_nanos - moment_nanos_ < kPlaceEveryNanos;
  if (!is_soon) return PassMomentNow(now_nanos, now_nanos);
  if (moment_nanos_ != 0 || late_moment_nanos_ == 0) late_moment_nanos_ = now_nanos;
}

// Of what came too soon after the last one: places are looked at only so often.
void BagSource::PassLateMoment() {
  const std::int64_t late = std::exchange(late_moment_nanos_, 0);
  if (late == 0) return;
  PassMomentNow(moment_nanos_ == 0 ? late : moment_nanos_ + kPlaceEveryNanos, late);
}

void BagSource::PassMomentNow(std::int64_t now_nanos, std::int64_t stamp_nanos) {
  moment_nanos_ = now_nanos;
  late_moment_nanos_ = 0;
  if (world_.empty()) world_ = surroundings_.FirstFrame();
  surroundings_.Update(now_nanos, world_, name_, watch_);
  watch_.OnMoment({stamp_nanos, 0});
}

void BagSource::PassMomentWithoutPeople(std::int64_t now_nanos) {
  constexpr std::int64_t kSilentNanos = 500 * kNanosPerMilli;  // as a live stream becomes stale
  constexpr double kSilentSteps = 3;                           // of slow recordings
  const std::int64_t since = now_nanos - person_nanos_;
  if (needs_person_ || person_nanos_ == 0 || since <= kSilentNanos) return;
  joiner_.Flush();
  const double step_secs =
      watch_.step_nanos() != 0 || rate_hz_ <= 0 ? Secs(watch_.step_nanos()) : 1 / rate_hz_;
  if (Secs(since) <= kSilentSteps * step_secs) return;
  if (!surroundings_.HasSomething()) return;
  PassMoment(now_nanos, watch_.newest_nanos() + since);
}

void BagSource::TakeLinkStates(const BagMessage& message) {
  const bool is_whole = message.bytes.size() == message.size;
  if (!is_whole || !kinescope::ros_bridge::Decode(message.bytes, link_states_)) {
    ++counters_.rejected[kUnreadableLinkStates];
    return;
  }
  if (links_.empty()) {
    joiner_.Take(link_states_, counters_);
    return;
  }
  // A topic that began after the people were looked for.
  const auto person = links_.find(message.connection->topic);
  if (person == links_.end()) {
    ++counters_.ignored["topic " + message.connection->topic];
    return;
  }
  surroundings_.Update(message.recorded_nanos, world_, name_, watch_);
  told_people_.SetSink(&watch_);
  person->second.Take(link_states_, {message.recorded_nanos, 0}, origin_, counters_, told_people_);
}

ToldPeople::Key BagSource::KeyOf(int character) const {
  const std::size_t index = urdf::At(character);
  if (!links_.empty()) {
    return {"", index < links_.size()
                    ? NamespaceOf(WithSlash(std::next(links_.begin(), character)->first))
                    : ""};
  }
  const auto& people = people_.people();
  return {index < people.size() ? people[index].frames[urdf::kPelvis] : "", ""};
}

void BagSource::TakePeople(const BagMessage& message) {
  const bool is_whole = message.bytes.size() == message.size;
  if (!is_whole || !told_people_.Take(message.bytes)) ++counters_.rejected[kUnreadablePeople];
}

SourceCounters BagSource::counters() const {
  SourceCounters counters = counters_;
  for (const auto& [connection, messages] : messages_.others()) {
    std::string what = fmt::format("topic {} ({})", connection->topic, connection->type);
    if (BagSurroundings::CanBeShown(*connection)) what += "; --marker_topics shows it";
    if (HasTransformType(*connection) && !EndsWith(connection->topic, "_static"))
      what += "; --tf_topic takes people from it";
    counters.ignored[what] += messages;
    counters.datagrams += messages;
  }
  for (const auto& [defect, records] : messages_.defects()) {
    counters.rejected[defect] += records;
    counters.datagrams += records;
  }
  counters.problems = common_frame_.problems();
  return counters;
}

const char* BagSource::Decode(const BagMessage& message) {
  if (!HasTransformType(*message.connection)) return kOtherType;
  const bool is_whole = message.bytes.size() == message.size;  // not too large to be delivered
  return is_whole && kinescope::ros_bridge::Decode(message.bytes, message_) ? nullptr
                                                                            : kUnreadableTransforms;
}

}  // namespace

std::unique_ptr<Source> OpenBag(const std::string& path, const GraphView& view) {
  return std::make_unique<BagSource>(path, view);
}

}  // namespace kinescope::ros_bridge
