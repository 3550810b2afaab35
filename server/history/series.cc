#include "server/history/series.h"

#include <algorithm>
#include <cmath>

#include "core/system/check.h"

namespace kinescope::history {
namespace {

constexpr std::int16_t kNarrowNone = std::numeric_limits<std::int16_t>::min();
constexpr double kRatioSteps = 2000, kPlaceSteps = 1e4;
constexpr std::int64_t kLossNanos = 1'000'000'000;
constexpr std::uint32_t kUsualSamples = 240;  // after which a smaller step is forgotten
constexpr std::uint32_t kLongestGap = 1u
                                      << 20;  // of the counter; a longer one is another recording

using SampleSteps = std::array<std::int32_t, kSeriesKeyCount>;

std::array<SeriesKey, kSeriesKeyCount> MakeKeys() {
  std::array<SeriesKey, kSeriesKeyCount> keys{};
  for (std::size_t i = 0; i < kSeriesJoints; ++i) {
    keys[i] = {urdf::kJoints[urdf::At(urdf::kScoredJoints[i])].ros_name, "1", kRatioSteps};
  }
  keys[kCompression] = {"compression", "N", 1};
  keys[kMargin] = {"margin", "m", kPlaceSteps};
  keys[kMediumJoints] = {"medium_joints", "1", 1};
  keys[kHighJoints] = {"high_joints", "1", 1};
  keys[kUnknownJoints] = {"unknown_joints", "1", 1};
  keys[kRate] = {"rate", "Hz", 50};
  keys[kLoss] = {"loss", "1", 1e4};
  keys[kComX] = {"com_x", "m", kPlaceSteps};
  keys[kComY] = {"com_y", "m", kPlaceSteps};
  keys[kCopX] = {"cop_x", "m", kPlaceSteps};
  keys[kCopY] = {"cop_y", "m", kPlaceSteps};
  return keys;
}

// A value beyond the range of its key becomes the nearest one that can be kept.
std::int32_t StepsOf(std::size_t key, double value) {
  if (!std::isfinite(value)) return SeriesColumn::kNone;
  const double most = key < kComX ? std::numeric_limits<std::int16_t>::max()
                                  : std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(
      std::clamp(std::round(value * SeriesKeys()[key].steps), -most, most));
}

SampleSteps ValuesOf(const SceneState& state, const PersonState& person, double loss) {
  SampleSteps values;
  values.fill(SeriesColumn::kNone);
  const auto put = [&](std::size_t key, double value) { values[key] = StepsOf(key, value); };
  int medium = 0, high = 0, unknown = 0;
  for (const JointLoad& load : person.loads) {
    const auto& joints = urdf::kScoredJoints;
    const auto found = std::find(joints.begin(), joints.end(), load.joint);
    if (found != joints.end()) put(static_cast<std::size_t>(found - joints.begin()), load.ratio);
    medium += load.load_class >= LoadClass::kMedium ? 1 : 0;
    high += load.load_class == LoadClass::kHigh ? 1 : 0;
    unknown += load.load_class == LoadClass::kUnknown ? 1 : 0;
  }
  put(kMediumJoints, medium);
  put(kHighJoints, high);
  put(kUnknownJoints, unknown);
  put(kRate, state.rate_hz);
  put(kLoss, loss);
  const bool is_live = state.liveness == Liveness::kLive;
  if (is_live && person.forces.lumbar) put(kCompression, person.forces.lumbar->compression);
  if (is_live && person.forces.margin_of_stability)
    put(kMargin, *person.forces.margin_of_stability);
  if (person.com) {
    put(kComX, person.com->x());
    put(kComY, person.com->y());
  }
  if (person.cop) {
    put(kCopX, person.cop->x());
    put(kCopY, person.cop->y());
  }
  return values;
}

void Merge(const SeriesColumn& later, SeriesColumn& column) {
  if (!later.is_known()) return;
  column.min = column.is_known() ? std::min(column.min, later.min) : later.min;
  column.max = column.is_known() ? std::max(column.max, later.max) : later.max;
  column.last = later.last;
}

}  // namespace

const std::array<SeriesKey, kSeriesKeyCount>& SeriesKeys() {
  static const std::array<SeriesKey, kSeriesKeyCount> kKeys = MakeKeys();
  return kKeys;
}

std::optional<std::size_t> FindSeriesKey(std::string_view name) {
  const auto& keys = SeriesKeys();
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&](const SeriesKey& key) { return key.name == name; });
  if (found == keys.end()) return std::nullopt;
  return static_cast<std::size_t>(found - keys.begin());
}

std::int64_t Series::Block::nanos(std::size_t row) const {
  return first_nanos + 1000 * static_cast<std::int64_t>(after_micros[row]);
}

std::int32_t Series::Block::At(std::size_t key, std::size_t row) const {
  if (key >= kNarrowKeys) return wide[key - kNarrowKeys][row];
  return narrow[key][row] == kNarrowNone ? SeriesColumn::kNone : narrow[key][row];
}

void Series::Block::Put(std::int64_t nanos, const SampleSteps& values) {
  if (count == 0) first_nanos = nanos;
  after_micros[count] = static_cast<std::uint32_t>((nanos - first_nanos) / 1000);
  for (std::size_t key = 0; key < kSeriesKeyCount; ++key) {
    const std::int32_t value = values[key];
    if (key >= kNarrowKeys) {
      wide[key - kNarrowKeys][count] = value;
    } else {
      narrow[key][count] =
          value == SeriesColumn::kNone ? kNarrowNone : static_cast<std::int16_t>(value);
    }
    Merge({value, value, value}, all[key]);
  }
  ++count;
}

double Series::LossMeter::Add(std::uint32_t counter, std::int64_t nanos) {
  const std::uint32_t step = last_ ? counter - *last_ : 0;
  last_ = counter;
  std::uint32_t lost = 0;
  if (step > 0 && step < kLongestGap) {
    if (seen_ >= kUsualSamples) {
      smallest_before_ = smallest_;
      smallest_ = seen_ = 0;
    }
    ++seen_;
    smallest_ = smallest_ == 0 ? step : std::min(smallest_, step);
    const std::uint32_t usual =
        smallest_before_ == 0 ? smallest_ : std::min(smallest_, smallest_before_);
    lost = step / usual - 1;
  }
  steps_.push_back({nanos, lost});
  lost_ += lost;
  while (steps_.front().nanos <= nanos - kLossNanos) {
    lost_ -= steps_.front().lost;
    steps_.pop_front();
  }
  return static_cast<double>(lost_) / static_cast<double>(lost_ + steps_.size());
}

void Series::Add(const SceneState& state) {
  const std::lock_guard lock(mutex_);
  for (const PersonState& person : state.people) AddPerson(state, person);
  Forget(state.made_nanos);
}

void Series::AddPerson(const SceneState& state, const PersonState& person) {
  constexpr std::int64_t kLongestBlock = 3'600'000'000'000;  // that after_micros can count
  Track& track = tracks_[person.character];
  const BodySample& sample = person.sample;
  const bool is_new = track.blocks.empty() || sample.counter != track.counter ||
                      sample.stamp_nanos != track.stamp_nanos;
  if (!is_new && state.liveness == track.liveness) return;
  const double loss = is_new ? track.loss.Add(sample.counter, state.made_nanos) : 0;
  track.counter = sample.counter;
  track.stamp_nanos = sample.stamp_nanos;
  track.liveness = state.liveness;
  if (track.blocks.empty() || track.blocks.back()->count == kBlockRows ||
      state.made_nanos - track.blocks.back()->first_nanos > kLongestBlock) {
    track.blocks.push_back(std::make_shared<Block>());
    ++blocks_;
  }
  track.blocks.back()->Put(state.made_nanos, ValuesOf(state, person, loss));
}

void Series::Forget(std::int64_t now_nanos) {
  const auto is_old = [&](const Track& track) {
    const Block& first = *track.blocks.front();
    return first.nanos(first.count - 1) < now_nanos - limits_.nanos;
  };
  const auto forget = [&](auto track) {
    track->second.blocks.pop_front();
    --blocks_;
    return track->second.blocks.empty() ? tracks_.erase(track) : track;
  };
  for (auto track = tracks_.begin(); track != tracks_.end();) {
    track = is_old(track->second) ? forget(track) : std::next(track);
  }
  while (blocks_ * sizeof(Block) > limits_.bytes) {
    forget(std::min_element(tracks_.begin(), tracks_.end(), [](const auto& a, const auto& b) {
      return a.second.blocks.front()->first_nanos < b.second.blocks.front()->first_nanos;
    }));
  }
}

std::vector<std::shared_ptr<const Series::Block>> Series::BlocksOf(
    const SeriesQuestion& question) const {
  std::vector<std::shared_ptr<const Block>> found;
  const std::lock_guard lock(mutex_);
  const auto track = tracks_.find(question.character);
  if (track == tracks_.end()) return found;
  const auto& blocks = track->second.blocks;
  auto each = std::lower_bound(blocks.begin(), blocks.end(), question.from_nanos,
                               [](const std::shared_ptr<Block>& block, std::int64_t nanos) {
                                 return block->nanos(block->count - 1) < nanos;
                               });
  for (; each != blocks.end() && (*each)->first_nanos < question.until_nanos; ++each) {
    const bool may_grow = *each == blocks.back();
    found.push_back(may_grow ? std::make_shared<const Block>(**each) : *each);
  }
  return found;
}

std::optional<SeriesAnswer> Series::Ask(const SeriesQuestion& question) const {
  const std::int64_t from = question.from_nanos, until = question.until_nanos;
  const auto columns = static_cast<std::int64_t>(question.columns);
  KINESCOPE_CHECK(from < until && columns > 0);
  // Of microseconds, so that a day in many columns does not overflow.
  const std::int64_t width = std::max<std::int64_t>(1, (until - from) / 1000);
  const auto column_at = [&](std::int64_t nanos) {
    const std::int64_t column = (nanos - from) / 1000 * columns / width;
    return static_cast<std::size_t>(std::min(column, columns - 1));
  };
  if (!Has(question.character)) return std::nullopt;
  const auto blocks = BlocksOf(question);
  SeriesAnswer answer;
  answer.samples.resize(question.columns);
  answer.by_key.assign(question.keys.size(), std::vector<SeriesColumn>(question.columns));
  for (const std::shared_ptr<const Block>& each : blocks) {
    const Block& block = *each;
    const std::int64_t first = block.first_nanos, last = block.nanos(block.count - 1);
    if (first >= from && last < until && column_at(first) == column_at(last)) {
      const std::size_t column = column_at(first);
      answer.samples[column] += static_cast<std::uint32_t>(block.count);
      for (std::size_t i = 0; i < question.keys.size(); ++i) {
        Merge(block.all[question.keys[i]], answer.by_key[i][column]);
      }
      continue;
    }
    for (std::size_t row = 0; row < block.count; ++row) {
      const std::int64_t nanos = block.nanos(row);
      if (nanos < from || nanos >= until) continue;
      const std::size_t column = column_at(nanos);
      ++answer.samples[column];
      for (std::size_t i = 0; i < question.keys.size(); ++i) {
        const std::int32_t value = block.At(question.keys[i], row);
        Merge({value, value, value}, answer.by_key[i][column]);
      }
    }
  }
  return answer;
}

bool Series::Has(int character) const {
  const std::lock_guard lock(mutex_);
  return tracks_.count(character) > 0;
}

std::vector<int> Series::characters() const {
  const std::lock_guard lock(mutex_);
  std::vector<int> all;
  for (const auto& [character, track] : tracks_) all.push_back(character);
  return all;
}

std::size_t Series::bytes() const {
  const std::lock_guard lock(mutex_);
  return blocks_ * sizeof(Block);
}

}  // namespace kinescope::history
