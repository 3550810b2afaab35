#include "server/history/chunk.h"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/system/check.h"
#include "server/history/state_visitor.h"

namespace kinescope::history {
namespace {

using Values = std::vector<std::int64_t>;

constexpr std::int64_t kNotANumber = std::int64_t{1} << 52;
constexpr int kLevel = 1;  // of zstd, the quickest: it works beside the stream

class Writer {
 public:
  Writer(std::vector<std::string_view>& texts, Values& out) : texts_(texts), out_(out) {}

  void Number(double value, double step) {
    const double steps = std::round(value / step);
    out_.push_back(std::abs(steps) < kNotANumber ? static_cast<std::int64_t>(steps) : kNotANumber);
  }
  template <class T>
  void Whole(const T& value) {
    out_.push_back(static_cast<std::int64_t>(value));
  }
  void Turn(const Eigen::Quaterniond& turn) {
    for (int i = 0; i < 4; ++i) Number(turn.coeffs()[i], kTurn);
  }
  void Text(std::string_view text) {
    const auto found = std::find(texts_.begin(), texts_.end(), text);
    out_.push_back(found - texts_.begin());
    if (found == texts_.end()) texts_.push_back(text);
  }
  template <class T, class Visit>
  void Optional(const std::optional<T>& value, const Visit& visit) {
    Whole(value.has_value());
    if (value) return visit(*value);
    const T none = Nothing<T>();
    visit(none);
  }

  template <class T>
  static T Nothing() {
    if constexpr (std::is_same_v<T, Eigen::Vector3d>) return T::Zero();
    return T();
  }

 private:
  std::vector<std::string_view>& texts_;
  Values& out_;
};

class Reader {
 public:
  Reader(const std::vector<std::string_view>& texts, const std::int64_t* from)
      : texts_(texts), next_(from) {}

  void Number(double& value, double step) {
    const std::int64_t steps = *next_++;
    value = steps == kNotANumber ? std::numeric_limits<double>::quiet_NaN()
                                 : static_cast<double>(steps) * step;
  }
  template <class T>
  void Whole(T& value) {
    value = static_cast<T>(*next_++);
  }
  void Turn(Eigen::Quaterniond& turn) {
    for (int i = 0; i < 4; ++i) Number(turn.coeffs()[i], kTurn);
    turn.normalize();
  }
  void Text(std::string_view& text) { text = texts_[static_cast<std::size_t>(*next_++)]; }
  template <class T, class Visit>
  void Optional(std::optional<T>& value, const Visit& visit) {
    const bool is_there = *next_++ != 0;
    value = Writer::Nothing<T>();
    visit(*value);
    if (!is_there) value.reset();
  }

 private:
  const std::vector<std::string_view>& texts_;
  const std::int64_t* next_;
};

// Differences wrap around, so they are of unsigned numbers.
std::uint64_t ZigZag(std::uint64_t difference) {
  return (difference << 1u) ^ (0 - (difference >> 63u));
}
std::uint64_t UnZigZag(std::uint64_t value) { return (value >> 1u) ^ (0 - (value & 1u)); }

void PutVarint(std::uint64_t value, std::vector<std::uint8_t>& out) {
  for (; value >= 0x80; value >>= 7u) out.push_back(static_cast<std::uint8_t>(value | 0x80u));
  out.push_back(static_cast<std::uint8_t>(value));
}

std::uint64_t TakeVarint(const std::uint8_t*& from) {
  std::uint64_t value = 0;
  for (unsigned shift = 0;; shift += 7) {
    const std::uint64_t byte = *from++;
    value |= (byte & 0x7Fu) << shift;
    if (byte < 0x80) return value;
  }
}

std::size_t VarintBytes(std::uint64_t value) {
  std::size_t bytes = 1;
  for (; value >= 0x80; value >>= 7u) ++bytes;
  return bytes;
}

// A column as differences, or as differences of these: what takes less.
void PutColumn(const std::vector<std::uint64_t>& column, std::vector<std::uint8_t>& out) {
  const auto visit = [&](bool is_twice, const auto& put) {
    std::uint64_t before = 0, step_before = 0;
    for (const std::uint64_t value : column) {
      const std::uint64_t step = value - before;
      put(ZigZag(is_twice ? step - step_before : step));
      step_before = before == 0 ? 0 : step;
      before = value;
    }
  };
  std::size_t once = 0, twice = 0;
  visit(false, [&](std::uint64_t value) { once += VarintBytes(value); });
  if (once == column.size()) {
    twice = once;  // nearly constant: no better way
  } else {
    visit(true, [&](std::uint64_t value) { twice += VarintBytes(value); });
  }
  const bool is_twice = twice < once;
  out.push_back(is_twice ? 1 : 0);
  visit(is_twice, [&](std::uint64_t value) { PutVarint(value, out); });
}

void TakeColumn(const std::uint8_t*& from, std::size_t count, std::size_t stride,
                std::int64_t* to) {
  const bool is_twice = *from++ != 0;
  std::uint64_t value = 0, step_before = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t difference = UnZigZag(TakeVarint(from));
    const std::uint64_t step = is_twice ? step_before + difference : difference;
    step_before = value == 0 ? 0 : step;  // the first step, from 0, is no motion
    value += step;
    to[i * stride] = static_cast<std::int64_t>(value);
  }
}

// What the form keeps of a state: no value of its moment that is not visited.
SceneState WithoutUnkept(const SceneState& state) {
  SceneState form = state;
  form.markers.clear();  // of History, by number
  form.images.clear();
  form.ghosts.clear();
  form.surroundings = 0;
  for (PersonState& person : form.people) {
    const int character = person.character;
    person.sample = BodySample();
    person.sample.character = character;
    person.angles = {};
    for (auto& glove : person.gloves) {
      if (glove) glove->angles = {};
    }
    for (auto& prop : person.props) {
      if (prop) prop->angles.setZero();
    }
    person.deviation = person.worst_deviation = {};
    person.forces = BodyForces();
  }
  for (TrackedObject& object : form.objects) object.stamp_nanos = 0;
  for (RobotState& robot : form.robots) {
    robot.bounds.setEmpty();
    for (Eigen::Isometry3d& link : robot.world_from_link) {
      link.matrix().topRows<3>().setConstant(std::nan(""));
    }
  }
  return form;
}

std::size_t RoomOf(const SceneState& form) {
  std::size_t bytes = sizeof form + form.people.size() * sizeof(PersonState);
  for (const PersonState& person : form.people) bytes += person.loads.size() * sizeof(JointLoad);
  for (const TrackedObject& object : form.objects) bytes += sizeof object + object.name.size();
  for (const RobotState& robot : form.robots) {
    bytes += sizeof robot + robot.world_from_link.size() * sizeof robot.world_from_link[0];
  }
  return bytes;
}

bool SameForm(const PersonState& a, const PersonState& b) {
  const auto same = [](const auto& x, const auto& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                      [](const auto& p, const auto& q) { return p.has_value() == q.has_value(); });
  };
  return a.character == b.character && a.name == b.name && a.model == b.model &&
         same(a.gloves, b.gloves) && same(a.props, b.props) &&
         std::equal(a.loads.begin(), a.loads.end(), b.loads.begin(), b.loads.end(),
                    [](const JointLoad& x, const JointLoad& y) { return x.joint == y.joint; });
}

}  // namespace

bool SameForm(const SceneState& a, const SceneState& b) {
  return a.source == b.source && a.class_limits == b.class_limits &&
         a.class_falls_below == b.class_falls_below &&
         std::equal(a.people.begin(), a.people.end(), b.people.begin(), b.people.end(),
                    [](const PersonState& x, const PersonState& y) { return SameForm(x, y); }) &&
         std::equal(a.objects.begin(), a.objects.end(), b.objects.begin(), b.objects.end(),
                    [](const TrackedObject& x, const TrackedObject& y) {
                      return x.character == y.character && x.number == y.number && x.name == y.name;
                    }) &&
         std::equal(a.robots.begin(), a.robots.end(), b.robots.begin(), b.robots.end(),
                    [](const RobotState& x, const RobotState& y) {
                      return x.name == y.name && x.model == y.model && x.moves == y.moves &&
                             x.problem == y.problem;
                    }) &&
         std::equal(a.left_out.begin(), a.left_out.end(), b.left_out.begin(), b.left_out.end(),
                    [](const LeftOutPerson& x, const LeftOutPerson& y) {
                      return x.character == y.character && x.why == y.why;
                    });
}

Chunk::Chunk(const std::vector<std::shared_ptr<const SceneState>>& states, const Chunk* before)
    : count_(states.size()),
      first_number_(states.front()->number),
      last_number_(states.back()->number),
      first_nanos_(states.front()->made_nanos),
      last_nanos_(states.back()->made_nanos),
      form_(before != nullptr && SameForm(*before->form_, *states.front())
                ? before->form_
                : std::make_shared<const SceneState>(WithoutUnkept(*states.front()))) {
  Values rows;
  Writer writer(texts_, rows);
  for (const auto& state : states) VisitState(writer, *state);
  columns_ = rows.size() / count_;
  KINESCOPE_CHECK(columns_ * count_ == rows.size());
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * rows.size());
  std::vector<std::uint64_t> column(count_);
  for (std::size_t i = 0; i < columns_; ++i) {
    for (std::size_t row = 0; row < count_; ++row) {
      column[row] = static_cast<std::uint64_t>(rows[row * columns_ + i]);
    }
    PutColumn(column, bytes);
  }
  length_ = bytes.size();
  packed_.resize(ZSTD_compressBound(length_));
  const std::size_t size =
      ZSTD_compress(packed_.data(), packed_.size(), bytes.data(), length_, kLevel);
  KINESCOPE_CHECK(ZSTD_isError(size) == 0);
  packed_.resize(size);
  packed_.shrink_to_fit();
  texts_.shrink_to_fit();
  bytes_ = sizeof *this + packed_.size() + texts_.size() * sizeof(std::string_view);
  if (before == nullptr || before->form_ != form_) bytes_ += RoomOf(*form_);
}

Chunk::Rows Chunk::Unpack() const {
  std::vector<std::uint8_t> bytes(length_);
  const std::size_t size = ZSTD_decompress(bytes.data(), length_, packed_.data(), packed_.size());
  KINESCOPE_CHECK(size == length_);
  Rows rows;
  rows.count_ = count_;
  rows.columns_ = columns_;
  rows.values_.resize(count_ * columns_);
  const std::uint8_t* from = bytes.data();
  for (std::size_t i = 0; i < columns_; ++i) {
    TakeColumn(from, count_, columns_, rows.values_.data() + i);
  }
  return rows;
}

std::shared_ptr<SceneState> Chunk::At(const Rows& rows, std::size_t row) const {
  auto state = std::make_shared<SceneState>(*form_);
  Reader reader(texts_, rows.values_.data() + row * columns_);
  VisitState(reader, *state);
  for (PersonState& person : state->people) {
    for (JointLoad& load : person.loads) {
      load.position = person.links[urdf::At(urdf::ChildOf(load.joint))].position;
    }
  }
  return state;
}

}  // namespace kinescope::history
