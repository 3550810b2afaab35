// The tables of `kinescope loads` as their readers parse them: columns, units, what is not known,
// and disks that are full.
#include "server/app/loads/load_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "server/table/load_rows.h"
#include "tests/csv_table.h"
#include "tests/full_disk.h"
#include "tests/server/app/loads/trial_scenes.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::AllOf;
using testing::CsvTable;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ReadFile;
using testing::SceneWithRatio;
using testing::ShortLift;
using testing::TempFolder;
using JsonValue = nlohmann::json;

constexpr double kNoRatioInFile = std::numeric_limits<double>::quiet_NaN();

// What `add` adds, as a file.
template <class Add>
std::string CsvOf(Layout layout, Add&& add, const Columns& columns = {}) {
  const TempFolder folder;
  const std::string path = folder / "loads.csv";
  const auto file = MakeCsv(path, layout, columns);
  add(*file);
  file->Finish({});
  return ReadFile(path);
}

template <class Add>
JsonValue JsonOf(const JsonValue& summary, Add&& add) {
  const TempFolder folder;
  const std::string path = folder / "loads.json";
  const auto file = MakeJson(path);
  add(*file);
  file->Finish(summary);
  return JsonValue::parse(ReadFile(path));
}

void AddShortLift(LoadFile& file) {
  for (const auto& scene : ShortLift()) {
    file.Add(scene->people[0], ShortLift().front()->stamp_nanos);
  }
}

// One sample of the lift, changed by `change`.
template <class Change>
PersonState LiftingPersonWith(Change&& change) {
  PersonState person = ShortLift().back()->people[0];
  change(person);
  return person;
}

class NumberNames : public CellSink {
 public:
  void Number(const std::string& name, double) override { names.push_back(name); }
  void Whole(const std::string&, long long) override {}
  void Text(const std::string&, std::string_view) override {}
  std::vector<std::string> names;
};

TEST(LoadFiles, HaveUniqueColumnNamesWithUnits) {
  const CsvTable table(CsvOf(Layout::kWide, AddShortLift));
  const std::set<std::string> distinct(table.names.begin(), table.names.end());
  EXPECT_EQ(distinct.size(), table.names.size());
  for (const char* name :
       {"time_s", "utc", "sample_counter", "person", "metric", "ground_force_z_N", "cop_x_m",
        "l5_s1_compression_N", "right_hand_load_kg", "right_knee_ratio", "right_knee_class",
        "left_ankle_reason"}) {
    EXPECT_EQ(distinct.count(name), 1U) << name;
  }
  NumberNames numbers;
  VisitWide(ShortLift().back()->people[0], 0, {true, true}, numbers);
  EXPECT_GT(numbers.names.size(), 22U * 10);
  for (const std::string& name : numbers.names) {
    const std::string unit = name.substr(name.rfind('_') + 1);
    EXPECT_THAT(unit, ::testing::AnyOf("s", "m", "m2", "N", "Nm", "kg", "ratio")) << name;
  }
}

TEST(LoadFiles, ContainTheSameColumnsAndValuesInJsonAndCsv) {
  const CsvTable table(CsvOf(Layout::kWide, AddShortLift));
  const JsonValue json = JsonOf({}, AddShortLift);
  EXPECT_EQ(json.at("columns").get<std::vector<std::string>>(), table.names);
  ASSERT_EQ(json.at("samples").size(), ShortLift().size());
  ASSERT_EQ(table.rows.size(), ShortLift().size());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const JsonValue& sample = json.at("samples").at(row);
    ASSERT_EQ(sample.size(), table.names.size());
    for (std::size_t i = 0; i < table.names.size(); ++i) {
      const std::string& cell = table.rows[row][i];
      const JsonValue& value = sample.at(i);
      if (value.is_null()) {
        EXPECT_EQ(cell, "") << table.names[i];
      } else if (value.is_string()) {
        EXPECT_EQ(cell, value.get<std::string>()) << table.names[i];
      } else {
        EXPECT_EQ(std::stod(cell), value.get<double>()) << table.names[i];
      }
    }
  }
}

TEST(LoadFiles, ContainRatiosAndTimesWithSevenDigits) {
  const CsvTable table(CsvOf(Layout::kWide, AddShortLift));
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const SceneState& scene = *ShortLift()[row];
    const PersonState& person = scene.people[0];
    EXPECT_NEAR(table.Number(row, "time_s"),
                Secs(scene.stamp_nanos - ShortLift().front()->stamp_nanos), 5e-7);
    EXPECT_EQ(table.At(row, "sample_counter"), std::to_string(person.sample.counter));
    EXPECT_EQ(table.Number(row, "right_hand_load_kg"),
              std::stod(fmt::format("{:.7g}", person.forces.hands[urdf::kRight].mass_kg)));
    for (std::size_t i = 0; i < person.loads.size(); ++i) {
      const std::string joint(ScoredName(i));
      EXPECT_NEAR(table.Number(row, joint + "_ratio"), person.loads[i].ratio,
                  1e-6 * person.loads[i].ratio);
      EXPECT_EQ(table.At(row, joint + "_class"), Name(person.loads[i].load_class));
    }
  }
}

TEST(LoadFiles, KeepMicrosecondsOfTimesForHours) {
  const CsvTable table(CsvOf(Layout::kWide, [](LoadFile& file) {
    file.Add(SceneWithRatio(36'000.123456, 0.2).people[0], 0);
  }));
  EXPECT_EQ(table.At(0, "time_s"), "36000.123456");
  EXPECT_EQ(table.At(0, "utc"), "1970-01-01T10:00:00.123456Z");
}

TEST(LoadFiles, ContainUnknownValuesAsEmptyCsvFieldsAndJsonNull) {
  const auto add = [](LoadFile& file) {
    PersonState person = SceneWithRatio(1, kNoRatioInFile, "no foot contact").people[0];
    person.loads[1].ratio = std::numeric_limits<double>::infinity();
    file.Add(person, 0);
  };
  const CsvTable table(CsvOf(Layout::kWide, add));
  for (std::size_t i = 0; i < 15; ++i) {
    const std::string joint(ScoredName(i));
    EXPECT_EQ(table.At(0, joint + "_ratio"), "");
    EXPECT_EQ(table.At(0, joint + "_class"), "unknown");
    EXPECT_EQ(table.At(0, joint + "_reason"), "no foot contact");
  }
  for (const char* name : {"cop_x_m", "com_minus_mvn_y_m", "margin_of_stability_m", "l5_s1_shear_N",
                           "metric_reason"}) {
    EXPECT_EQ(table.At(0, name), "") << name;
  }
  const JsonValue json = JsonOf({}, add);
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    EXPECT_EQ(json.at("samples").at(0).at(i).is_null(), table.rows[0][i].empty()) << table.names[i];
  }
}

TEST(LoadFiles, LeaveUnknownGroundReactionForcesEmpty) {
  const CsvTable table(CsvOf(Layout::kWide, [](LoadFile& file) {
    file.Add(LiftingPersonWith([](PersonState& person) {
               person.forces.why_no_ground = "no foot contact";
               person.forces.ground_force = Eigen::Vector3d::Zero();
             }),
             0);
  }));
  EXPECT_EQ(table.At(0, "ground_force_z_N"), "");
  EXPECT_EQ(table.At(0, "ground_reason"), "no foot contact");
}

TEST(LoadFiles, KeepCommasQuotesAndLineBreaksOfTexts) {
  constexpr std::string_view kOdd = "a, \"b\"\r\nc\td \x01 <e>";
  const auto add = [&](LoadFile& file) {
    file.Add(LiftingPersonWith([&](PersonState& person) { person.loads[3].reason = kOdd; }), 0);
  };
  const std::string csv = CsvOf(Layout::kWide, add);
  EXPECT_THAT(csv, HasSubstr("\"a, \"\"b\"\"\r\nc\td \x01 <e>\""));
  EXPECT_EQ(CsvTable(csv).At(0, "right_shoulder_reason"), kOdd);
  const JsonValue json = JsonOf({}, add);
  const auto columns = json.at("columns").get<std::vector<std::string>>();
  const auto at = std::find(columns.begin(), columns.end(), "right_shoulder_reason");
  EXPECT_EQ(json.at("samples").at(0).at(static_cast<std::size_t>(at - columns.begin())), kOdd);
}

TEST(LoadFiles, HaveOneRowPerJointInTheLongLayout) {
  const CsvTable wide(CsvOf(Layout::kWide, AddShortLift));
  const CsvTable tall(CsvOf(Layout::kLong, AddShortLift));
  EXPECT_THAT(
      std::vector<std::string>(tall.names.begin(), tall.names.begin() + 7),
      ElementsAre("time_s", "utc", "sample_counter", "person", "joint", "ratio", "shown_ratio"));
  ASSERT_EQ(tall.rows.size(), 15 * wide.rows.size());
  for (std::size_t row = 0; row < tall.rows.size(); ++row) {
    const std::string joint(ScoredName(row % 15));
    EXPECT_EQ(tall.At(row, "joint"), joint);
    for (const char* name : {"ratio", "class", "channel", "capacity_Nm", "moment_y_Nm"}) {
      EXPECT_EQ(tall.At(row, name), wide.At(row / 15, joint + "_" + name));
    }
    EXPECT_EQ(tall.At(row, "time_s"), wide.At(row / 15, "time_s"));
  }
}

TEST(LoadFiles, HaveAllJointsAndDetailsAfterTheUsualColumnsOnRequest) {
  const CsvTable usual(CsvOf(Layout::kWide, AddShortLift));
  const CsvTable more(CsvOf(Layout::kWide, AddShortLift, {true, true}));
  for (const std::string& name : usual.names) {
    EXPECT_EQ(more.At(1, name), usual.At(1, name)) << "the same as without the options";
  }
  const BodyForces& forces = ShortLift()[1]->people[0].forces;
  EXPECT_EQ(more.Number(1, "l5_s1_compression_ratio"), forces.lumbar->ratio);
  EXPECT_EQ(more.Number(1, "right_foot_heel_contact_ratio"), 1);
  EXPECT_EQ(more.Number(1, "ground_is_measured"), 0);
  EXPECT_EQ(more.Number(1, "right_hand_force_z_N"), forces.hands[urdf::kRight].force.z());
  EXPECT_GT(more.Number(1, "support_area_m2"), 0.05);
  EXPECT_EQ(more.At(1, "right_hip_next_channel"), ShortLift()[1]->people[0].loads[9].next_channel);
  EXPECT_EQ(more.At(1, "l4_l3_ratio") + more.At(1, "l4_l3_class"), "") << "has no capacity";
  const Eigen::Quaterniond l4_from_world = ShortLift()[1]
                                               ->people[0]
                                               .links[urdf::At(urdf::ParentOf(urdf::jL4L3))]
                                               .orientation.conjugate();
  EXPECT_NEAR(more.Number(1, "l4_l3_moment_y_Nm"),
              (l4_from_world * forces.joints[urdf::jL4L3].moment).y(), 1e-9);

  const CsvTable tall(CsvOf(Layout::kLong, AddShortLift, {true, false}));
  ASSERT_EQ(tall.rows.size(), 22 * usual.rows.size());
  EXPECT_EQ(tall.At(15, "joint"), "l4_l3");
  EXPECT_EQ(tall.At(15, "moment_x_Nm"),
            CsvTable(CsvOf(Layout::kWide, AddShortLift, {true, false})).At(0, "l4_l3_moment_x_Nm"));
}

TEST(LoadFiles, HaveTheReasonOfAJointWithoutCapacity) {
  const CsvTable table(CsvOf(Layout::kWide,
                             [](LoadFile& file) {
                               file.Add(LiftingPersonWith([](PersonState& person) {
                                          MakeUnknown("the stream stopped", person.forces);
                                        }),
                                        0);
                             },
                             {true, false}));
  EXPECT_EQ(table.At(0, "c1_head_reason"), "the stream stopped");
  EXPECT_EQ(table.At(0, "c1_head_moment_x_Nm"), "");
}

// Parent's axes turned by 90 deg about the vertical: the world's x is their -y.
TEST(LoadFiles, ContainMomentsAndForcesInTheAxesOfTheParentSegment) {
  const CsvTable table(CsvOf(Layout::kWide, [](LoadFile& file) {
    PersonState person = SceneWithRatio(0, 0.2).people[0];
    JointLoad& elbow = person.loads[5];
    elbow.moment = {10, 20, 30};
    elbow.force = {1, 2, 3};
    person.links[urdf::At(urdf::ParentOf(elbow.joint))].orientation =
        Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitZ());
    file.Add(person, 0);
  }));
  EXPECT_NEAR(table.Number(0, "right_elbow_moment_x_Nm"), 20, 1e-9);
  EXPECT_NEAR(table.Number(0, "right_elbow_moment_y_Nm"), -10, 1e-9);
  EXPECT_NEAR(table.Number(0, "right_elbow_moment_z_Nm"), 30, 1e-9);
  EXPECT_NEAR(table.Number(0, "right_elbow_force_x_N"), 2, 1e-9);
  EXPECT_NEAR(table.Number(0, "left_elbow_moment_x_Nm"), 0, 1e-9);
}

TEST(LoadFiles, AreValidForARecordingWithoutSamples) {
  EXPECT_EQ(CsvOf(Layout::kWide, [](LoadFile&) {}), "");
  const JsonValue json = JsonOf({{"source", "a.mvnx"}}, [](LoadFile&) {});
  EXPECT_THAT(json.at("columns"), IsEmpty());
  EXPECT_THAT(json.at("samples"), IsEmpty());
  EXPECT_EQ(json.at("source"), "a.mvnx");
}

TEST(LoadFiles, ContainTheSummaryInJsonEvenWithInvalidUtf8) {
  const JsonValue json =
      JsonOf({{"people", {{{"name", "Anna \xFF\xC0 \"x\"\x01 </script>"}}}}}, AddShortLift);
  EXPECT_EQ(json.at("people").at(0).at("name"), "Anna \uFFFD\uFFFD \"x\"\x01 </script>");
}

TEST(LoadFiles, AppearOnlyWhenTheyAreComplete) {
  const TempFolder folder;
  {
    const auto csv = MakeCsv(folder / "a.csv", Layout::kLong);
    const auto json = MakeJson(folder / "a.json");
    for (int i = 0; i < 10; ++i) {  // more than what is collected before it is written
      AddShortLift(*csv);
      AddShortLift(*json);
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "a.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.json"));
  }
  EXPECT_THAT(folder.Names(), IsEmpty()) << "Finish was never called";
}

template <class Action>
std::string LoadFileError(Action&& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(LoadFiles, NameTheFileAndTheReasonWhenTheDiskIsFull) {
  const TempFolder folder;
  const std::string csv = folder / "loads.csv", json = folder / "loads.json";
  {
    const testing::SmallFilesOnly full(1000);
    EXPECT_THAT(LoadFileError([&] {
                  const auto file = MakeCsv(csv, Layout::kWide);
                  AddShortLift(*file);
                  file->Finish({});
                }),
                AllOf(HasSubstr(csv), EndsWith(": File too large")));
    EXPECT_THAT(LoadFileError([&] {
                  const auto file = MakeJson(json);
                  AddShortLift(*file);
                  file->Finish({});
                }),
                AllOf(HasSubstr(json), EndsWith(": File too large")));
  }
  EXPECT_THAT(folder.Names(), IsEmpty());
}

TEST(LoadFiles, NameStandardOutputWhenItIsFull) {
  for (const int rounds : {1, 20}) {  // what fits into the buffer of the C library, and more
    std::string error;
    {
      const testing::FullStdout full;
      error = LoadFileError([&] {
        const auto file = MakeCsv("-", Layout::kWide);
        for (int i = 0; i < rounds; ++i) file->Add(SceneWithRatio(i, 0.2).people[0], 0);
        file->Finish({});
      });
    }
    EXPECT_THAT(error, HasSubstr("standard output"));
  }
}

TEST(LoadFiles, NameAPathThatIsNotWritable) {
  for (const char* path : {"/nowhere/loads.csv", "/proc/loads.csv"}) {
    EXPECT_THAT(LoadFileError([&] { MakeCsv(path, Layout::kWide); }), HasSubstr(path));
    EXPECT_THAT(LoadFileError([&] { MakeJson(path); }), HasSubstr(path));
  }
}

}  // namespace
}  // namespace kinescope::app
