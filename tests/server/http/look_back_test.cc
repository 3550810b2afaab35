#include "server/http/look_back.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "tests/server/http/past_message.h"
#include "tests/server/http/test_scene.h"

namespace kinescope::http::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kStep = 10'000'000;  // ns

// States 1 to `last`, one each kStep.
class LookBackTest : public ::testing::Test {
 protected:
  void Fill(std::uint64_t last, int people = 1, std::uint64_t first = 1) {
    for (std::uint64_t number = first; number <= last; ++number) {
      auto state = std::make_shared<SceneState>(MakeScene(number, 0.2, 1, model_, people));
      state->made_nanos = Nanos(number);
      history_.Add(std::move(state));
    }
    history_.Settle();
  }
  static std::int64_t Nanos(std::uint64_t number) {
    return kStep * static_cast<std::int64_t>(number);
  }
  std::optional<PastAnswer> Ask(const history::Span& span, std::size_t most = kMaxPastStates) {
    return AnswerLookBack({7, span, std::nullopt}, most, history_, details_, {});
  }
  PastMessage Run(const history::Span& span, std::size_t most = kMaxPastStates) {
    const auto answer = Ask(span, most);
    EXPECT_TRUE(answer);
    PastMessage message(answer ? answer->message : Bytes());
    EXPECT_THAT(message.states, SizeIs(answer ? answer->states : 0));
    return message;
  }

  const std::shared_ptr<const PersonModel> model_ = MakePersonModel(7);
  history::History history_;
  std::string prefix_ = "people: ";
  int details_made_ = 0;
  const DetailsOfState details_ = [this](const SceneState& state) {
    ++details_made_;
    return prefix_ + std::to_string(state.people.size());
  };
};

TEST_F(LookBackTest, HasNoAnswerBeforeTheFirstState) {
  EXPECT_FALSE(Ask({0, 0, 0}));
  EXPECT_FALSE(AnswerLookBack({7, {}, 1}, 1, history_, details_, {}));
}

TEST_F(LookBackTest, AnswersARunInOneMessage) {
  Fill(300);
  const PastMessage run = Run({Nanos(20), Nanos(39), 0});
  EXPECT_EQ(run.id, 7u);
  EXPECT_EQ(run.until_micros, 390'000);
  ASSERT_THAT(run.states, SizeIs(20));
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(run.states[i].number, 20 + i);
  EXPECT_THAT(Run({Nanos(20), Nanos(40), 10 * kStep}).Numbers(), ElementsAre(20, 30, 40));
}

TEST_F(LookBackTest, RepeatsNoDetailsThatAreEqual) {
  Fill(60);
  Fill(90, 2, 61);
  const PastMessage run = Run({Nanos(30), Nanos(90), 0});
  ASSERT_THAT(run.states, SizeIs(61));
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const char* const expected = i == 0 ? "people: 1" : i == 31 ? "people: 2" : "";
    EXPECT_EQ(run.states[i].details, expected) << i;
  }
  EXPECT_LE(details_made_, 5) << "they cost more than the state";
}

TEST_F(LookBackTest, SendsOtherTextsSoon) {
  Fill(64);
  int calls = 0;
  const auto answer =
      AnswerLookBack({7, {Nanos(1), Nanos(64), 0}, std::nullopt}, 64, history_,
                     [&](const SceneState&) { return "revision " + std::to_string(calls++); }, {});
  const PastMessage run(answer->message);
  EXPECT_EQ(run.states[0].details, "revision 0");
  EXPECT_EQ(run.states[15].details, "");
  EXPECT_EQ(run.states[16].details, "revision 1");
  EXPECT_EQ(run.states[63].details, "");
}

TEST_F(LookBackTest, GivesLessThanIsAskedForAndSaysSo) {
  Fill(600);
  const PastMessage many = Run({Nanos(1), Nanos(600), 0});
  EXPECT_THAT(many.states, SizeIs(kMaxPastStates));
  EXPECT_EQ(many.until_micros, 640'000) << "the last one that it has";
  const PastMessage few = Run({Nanos(1), Nanos(600), 0}, 3);
  EXPECT_THAT(few.Numbers(), ElementsAre(1, 2, 3));
  EXPECT_EQ(few.until_micros, 30'000);
  // A second between them: only so much of the history is unpacked for one answer.
  const PastMessage wide = Run({Nanos(1), Nanos(600), 100 * kStep});
  EXPECT_THAT(wide.Numbers(), ElementsAre(1, 101, 201, 301, 401, 501));
  EXPECT_EQ(wide.until_micros, 5'010'000);
  prefix_ = std::string(kMaxPastBytes, 'x');
  EXPECT_THAT(Run({Nanos(1), Nanos(600), 0}).states, SizeIs(1)) << "one, however large it is";
}

TEST_F(LookBackTest, GivesTheNearestStatesToMomentsThatItDoesNotHave) {
  Fill(300);
  const PastMessage gone = Run({-5'000'000'000, 0, 0});
  EXPECT_THAT(gone.Numbers(), ElementsAre(1)) << "the oldest";
  EXPECT_THAT(Run({-50'000'000'000, Nanos(3), 0}).Numbers(), ElementsAre(1, 2, 3));
  const PastMessage future = Run({Nanos(1000), Nanos(2000), 0});
  EXPECT_THAT(future.Numbers(), ElementsAre(300)) << "the newest";
  EXPECT_EQ(future.until_micros, 3'000'000);
  const auto numbered = AnswerLookBack({7, {}, 5}, 1, history_, details_, {});
  EXPECT_THAT(PastMessage(numbered->message).Numbers(), ElementsAre(5));
}

}  // namespace
}  // namespace kinescope::http::testing
