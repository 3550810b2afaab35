// What a trial amounts to in words and numbers.
#include "server/app/loads/load_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <sstream>

#include "server/table/load_rows.h"
#include "tests/server/app/loads/trial_scenes.h"

namespace kinescope::app {
namespace {

using testing::AddTo;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::SceneWithRatio;
using testing::ShortLift;
using testing::TrialOf;

constexpr double kNoRatioInSummary = std::numeric_limits<double>::quiet_NaN();

// "value", or "value (assumed)", by label.
std::map<std::string, std::string> FactTexts(const LoadTrial& trial, const TrialContext& context) {
  std::map<std::string, std::string> texts;
  for (const Fact& fact : FactsOf(trial, context)) {
    texts[fact.label] = fact.value + (fact.is_assumed ? " (assumed)" : "");
  }
  return texts;
}

LoadTrial TrialOfBody(const urdf::BodyDescription& body, bool lengths_are_measured = false,
                      const HandLoad& hands = {}) {
  SceneState scene = SceneWithRatio(0, 0.2);
  auto model = std::make_shared<PersonModel>();
  model->description = body;
  model->lengths_are_measured = lengths_are_measured;
  model->human.skeleton = urdf::DefaultSkeleton(1.68);
  model->human.body = urdf::MakeBodyParameters(body, model->human.skeleton);
  scene.people[0].model = model;
  scene.people[0].forces.stated_hand_load = hands;
  LoadTrial trial(false, 0);
  AddTo(trial, scene);
  return trial;
}

TEST(LoadSummary, DistinguishesGivenFromAssumedValues) {
  TrialContext context;
  const auto assumed = FactTexts(TrialOfBody({}), context);
  EXPECT_EQ(assumed.at("sex"), "male (assumed)");
  EXPECT_EQ(assumed.at("mass"), "75 kg (assumed)");
  EXPECT_EQ(assumed.at("stature"), "1.68 m (assumed)");
  EXPECT_EQ(assumed.at("hand load"), "nothing (assumed)");

  urdf::BodyDescription body;
  body.sex = urdf::Sex::kFemale;
  body.mass_kg = 61.5;
  body.sex_is_assumed = body.mass_is_assumed = false;
  body.added_masses = {{urdf::kHead, 1.5, Eigen::Vector3d::Zero()},
                       {urdf::kT8, 8, Eigen::Vector3d::Zero()}};
  context.scene.height_is_assumed = false;
  context.scene.loads.strength.factor = 0.8;
  context.scene.loads.strength.percentile = loads::Percentile::k5;
  const auto given = FactTexts(TrialOfBody(body, false, {true, {5, 2.5}, 10}), context);
  EXPECT_EQ(given.at("sex"), "female");
  EXPECT_EQ(given.at("mass"), "61.5 kg");
  EXPECT_EQ(given.at("stature"), "1.68 m");
  EXPECT_EQ(given.at("hand load"), "5 kg right, 2.5 kg left, 10 kg both hands");
  EXPECT_EQ(given.at("added mass"), "1.5 kg on head, 8 kg on t8");
  EXPECT_EQ(given.at("load metric"),
            "total moment relative to the 5th percentile of capacity x 0.8");
  EXPECT_EQ(FactTexts(TrialOfBody({}, true), TrialContext()).at("stature"),
            "1.68 m (from the source)");
}

// As a bag has them.
TEST(LoadSummary, SaysWhatChangedInTheRecording) {
  LoadTrial trial(false, 0);
  const auto add = [&](double secs, double mass, double both_kg) {
    SceneState scene = SceneWithRatio(secs, 0.2);
    auto model = std::make_shared<PersonModel>(*scene.people[0].model);
    model->description.mass_kg = mass;
    model->description.mass_is_assumed = false;
    scene.people[0].model = model;
    scene.people[0].forces.stated_hand_load = {true, {0, 0}, both_kg};
    AddTo(trial, scene);
  };
  add(0, 90, 10);
  add(0.5, 90, 10);
  EXPECT_EQ(ToldText(trial), "");
  add(1, 90, 4);
  add(1.5, 60, 4);
  add(2, 60, 4);
  EXPECT_EQ(
      ToldText(trial),
      "Body mass and hand load changed during the recording: from 0.00 s 90 kg, male, holding "
      "10 kg both hands; from 1.00 s 90 kg, male, holding 4 kg both hands; from 1.50 s 60 kg, "
      "male, holding 4 kg both hands.");
  EXPECT_THAT(NotesOf(trial, TrialContext()), Contains(ToldText(trial)));
  EXPECT_EQ(FactTexts(trial, TrialContext()).at("hand load"),
            "10 kg both hands; from 1.00 s 4 kg both hands");
  EXPECT_EQ(FactTexts(trial, TrialContext()).at("mass"), "90 kg; from 1.50 s 60 kg");
}

TEST(LoadSummary, TellsAHandLoadThatIsUnknownFromOneThatIsEmpty) {
  LoadTrial trial(false, 0);
  for (const auto& [secs, hands] :
       {std::pair(0.0, HandLoad()), std::pair(1.0, HandLoad{true, {0, 0}, 10}),
        std::pair(2.0, HandLoad{true, {0, 0}, 0})}) {
    SceneState scene = SceneWithRatio(secs, 0.2);
    scene.people[0].forces.stated_hand_load = hands;
    AddTo(trial, scene);
  }
  EXPECT_EQ(FactTexts(trial, TrialContext()).at("hand load"),
            "nothing (assumed); from 1.00 s 10 kg both hands; from 2.00 s nothing");
  EXPECT_THAT(ToldText(trial),
              HasSubstr("from 0.00 s 75 kg (assumed), male, hand load unknown; from 1.00 s"));
}

TEST(LoadSummary, NamesTheLoadMode) {
  TrialContext context;
  SceneState scene = SceneWithRatio(0, 0.2);
  scene.people[0].forces.is_dynamic = true;
  LoadTrial dynamic(false, 0);
  AddTo(dynamic, scene);
  EXPECT_THAT(FactTexts(dynamic, context).at("load mode"),
              HasSubstr("dynamic, accelerations below "));
  context.scene.loads.motion.dynamic = false;
  EXPECT_EQ(FactTexts(dynamic, context).at("load mode"), "static");
}

TEST(LoadSummary, GroupsJointsThatAreUnknownForTheSameReason) {
  LoadTrial trial(false, 0);
  for (int i = 0; i < 40; ++i) {
    SceneState scene = SceneWithRatio(0.1 * i, 0.2);
    for (const std::size_t joint : {9U, 10U}) {
      JointLoad& load = scene.people[0].loads[joint];
      load.ratio = kNoRatioInSummary;
      load.load_class = load.band = LoadClass::kUnknown;
      load.reason = i < 30 ? "no foot contact" : "";
    }
    AddTo(trial, scene);
  }
  trial.Finish();
  EXPECT_THAT(
      NotesOf(trial, {}),
      Contains(
          "Load unknown for 75 % of the time (3.00 s): Right hip, Left hip (no foot contact)."));
}

TEST(LoadSummary, PrintsOneLinePerJointAndDashesForUnknownValues) {
  LoadTrial trial(false, 0);
  for (int i = 0; i < 40; ++i) {
    SceneState scene = SceneWithRatio(0.1 * i, i < 20 ? 0.2 : kNoRatioInSummary);
    JointLoad& elbow = scene.people[0].loads[5];
    elbow.channel = "flexion";
    elbow.deciding_moment = -12.34;
    elbow.capacity = 61.7;
    scene.people[0].loads[6].ratio = kNoRatioInSummary;
    scene.people[0].loads[6].band = LoadClass::kUnknown;
    AddTo(trial, scene);
  }
  trial.Finish();
  TrialContext context;
  context.source = "take.mvnx";
  const std::string text = SummaryText(SummaryOf(trial, context));
  EXPECT_THAT(text, HasSubstr("take.mvnx, Person 0: 40 samples, 4.00 s\n"));
  std::map<std::string, std::vector<std::string>> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line.size() > 15 ? line.substr(15) : "");
    for (std::string word; words >> word;) lines[line.substr(0, 15)].push_back(word);
  }
  for (std::size_t i = 0; i < 15; ++i) {
    const std::string label = std::string(ScoredLabel(i)) + std::string(15, ' ');
    EXPECT_THAT(lines[label.substr(0, 15)], Not(::testing::IsEmpty())) << label;
  }
  EXPECT_THAT(lines["Right elbow    "],
              ::testing::ElementsAre("100.0", "%", "0.0", "%", "0.0", "%", "50.0", "%", "0.20",
                                     "0.20", "0.20", "0.20", "0.00", "s", "0.00", "s", "0",
                                     "flexion", "12.3", "of", "61.7", "N·m"));
  EXPECT_THAT(lines["Left elbow     "], ::testing::ElementsAre("-", "-", "-", "100.0", "%", "-",
                                                               "-", "-", "-", "-", "-", "-"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(LoadSummary, ContainsNullForUnknownValuesInValidJson) {
  LoadTrial trial(false, 0);
  for (int i = 0; i <= 10; ++i)
    AddTo(trial, SceneWithRatio(0.1 * i, kNoRatioInSummary, "no foot contact"));
  const auto json = nlohmann::json::parse(SummaryJson(SummaryOf(trial, {})).dump());
  ASSERT_EQ(json.at("exposure").size(), 15U);
  for (std::size_t i = 0; i < 15; ++i) {
    const auto& joint = json.at("exposure").at(i);
    EXPECT_EQ(joint.at("joint"), std::string(ScoredName(i)));
    for (const char* key : {"p10", "p50", "p90", "peak_ratio", "peak_time_s", "peak_channel",
                            "peak_moment_Nm", "peak_capacity_Nm"}) {
      EXPECT_TRUE(joint.at(key).is_null()) << key;
    }
    EXPECT_NEAR(joint.at("seconds").at("unknown").get<double>(), 1, 1e-9);
    EXPECT_NEAR(joint.at("unknown").at("no foot contact").get<double>(), 1, 1e-9);
  }
  for (const char* key : {"com_minus_mvn_m", "l5_s1_compression_N", "l5_s1_shear_N"}) {
    EXPECT_TRUE(json.at(key).is_null()) << key;
  }
}

TEST(LoadSummary, ContainsThePeaksOfTheLiftInJson) {
  const auto json = SummaryJson(SummaryOf(TrialOf(ShortLift()), {}));
  double most_ratio = 0, most_compression = 0;
  for (const auto& scene : ShortLift()) {
    most_ratio = std::max(most_ratio, scene->people[0].loads[5].ratio);
    most_compression = std::max(most_compression, scene->people[0].forces.lumbar->compression);
  }
  EXPECT_EQ(json.at("exposure").at(5).at("peak_ratio"), most_ratio);
  EXPECT_EQ(json.at("l5_s1_compression_N").at("most"), most_compression);
  EXPECT_EQ(json.at("samples"), ShortLift().size());
  const double step = 0.25 / static_cast<double>(ShortLift().size() - 1);
  EXPECT_NEAR(json.at("seconds").get<double>(), 0.25 + step, 1e-6);
}

TEST(LoadSummary, HasTheNameOfThePersonInItsTitle) {
  SceneState scene = SceneWithRatio(0, 0.2);
  scene.people[0].character = 3;
  LoadTrial nameless(false, 0), named(false, 0);
  AddTo(nameless, scene);
  scene.people[0].name = "Anna";
  AddTo(named, scene);
  EXPECT_EQ(TitleOf(nameless), "Person 3");
  EXPECT_EQ(TitleOf(named), "Anna (person 3)");
}

}  // namespace
}  // namespace kinescope::app
