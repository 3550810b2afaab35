#include "server/wrenches/wrench_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/system/errors.h"
#include "tests/server/wrenches/wrenches_testing.h"

namespace kinescope::wrenches {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kHeader;
using testing::ReadCsv;
using testing::ReadRows;
using ::testing::StartsWith;

constexpr char kMotStart[] =
    "external forces\nversion=1\nnRows=1\nnColumns=10\ninDegrees=yes\nendheader\n";
constexpr char kMotLabels[] =
    "time\tground_force_1_vx\tground_force_1_vy\tground_force_1_vz\tground_force_1_px\t"
    "ground_force_1_py\tground_force_1_pz\tground_torque_1_x\tground_torque_1_y\tground_torque_1_"
    "z\n";

WrenchSettings RightFootOf(const char* group) {
  WrenchSettings settings;
  settings.groups = {{group, WrenchBody::kRightFoot}};
  return settings;
}

template <class Read>
std::string ErrorOf(Read&& read) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

std::string MotError(const std::string& text, const WrenchSettings& settings = {}) {
  return ErrorOf([&] { ReadRows(text, WrenchFormat::kMot, settings); });
}

TEST(WrenchReader, ReadsTheRowsOfACsv) {
  const auto rows = ReadCsv(
      "0,RightFoot,-10,20,700,0.27,0.25,0,0,0,-4\n"
      "0,left_hand,0,0,-49.03,,,,0,0,0\n"
      "\n"
      "0.001,RightFoot,+1e1,0,7.5e2,0,0,0,0,0,0");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].body, WrenchBody::kRightFoot);
  EXPECT_EQ(rows[0].force, Vector3d(-10, 20, 700));
  EXPECT_EQ(*rows[0].point, Vector3d(0.27, 0.25, 0));
  EXPECT_EQ(rows[0].torque, Vector3d(0, 0, -4));
  EXPECT_EQ(rows[1].body, WrenchBody::kLeftHand);
  EXPECT_FALSE(rows[1].point);
  EXPECT_EQ(rows[2].secs, 0.001);
  EXPECT_EQ(rows[2].force, Vector3d(10, 0, 750));
}

TEST(WrenchReader, ReadsColumnsInAnyOrderAndLineBreaksOfWindowsAfterAByteOrderMark) {
  const auto rows = ReadRows(
      "\xef\xbb\xbf"
      "body, time_s,tx_Nm,ty_Nm,tz_Nm,px_m,py_m,pz_m,fx_N,fy_N,fz_N\r\n"
      "Ground, 2,1,2,3,4,5,6,7,8,9\r\n",
      WrenchFormat::kCsv);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].secs, 2);
  EXPECT_EQ(rows[0].torque, Vector3d(1, 2, 3));
  EXPECT_EQ(*rows[0].point, Vector3d(4, 5, 6));
  EXPECT_EQ(rows[0].force, Vector3d(7, 8, 9));
}

// biomech-files.md D.1: the same wrench in both files.
TEST(WrenchReader, TurnsTheYUpRowsOfAMotFile) {
  const auto rows = ReadRows(
      std::string(kMotStart) + kMotLabels + "0.5\t-10\t700\t-20\t0.27\t0\t-0.25\t0\t-4\t0\n",
      WrenchFormat::kMot, RightFootOf("ground_force_1"));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].secs, 0.5);
  EXPECT_EQ(rows[0].force, Vector3d(-10, 20, 700));
  EXPECT_EQ(*rows[0].point, Vector3d(0.27, 0.25, 0));
  EXPECT_EQ(rows[0].torque, Vector3d(0, 0, -4));
}

TEST(WrenchReader, ReadsTheOlderHeaderOfSimm) {
  const auto rows = ReadRows("name x.mot\ndatacolumns 10\ndatarows 1\nrange 0 1\nendheader\n" +
                                 std::string(kMotLabels) + "0 0 1 0 0 0 0 0 0 0\n",
                             WrenchFormat::kMot, RightFootOf("ground_force_1"));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].force, Vector3d(0, 0, 1));
}

// Labels of one body: force, point, torque.
std::string LabelsOf(const std::string& force, const std::string& point,
                     const std::string& torque) {
  std::string labels;
  for (const std::string& stem : {force, point, torque}) {
    for (const char* axis : {"x", "y", "z"}) labels += "\t" + stem + axis;
  }
  return labels;
}

TEST(WrenchReader, KnowsTheBodyOfAGroupWhoseNameTellsIt) {
  const std::string values = "\t0\t1\t0\t0\t0\t0\t0\t0\t0";
  const std::map<std::string, WrenchBody> expected = {
      {LabelsOf("ground_force_r_v", "ground_force_r_p", "ground_torque_r_"),
       WrenchBody::kRightFoot},
      {LabelsOf("ground_force_calcn_l_v", "ground_force_calcn_l_p", "ground_moment_calcn_l_m"),
       WrenchBody::kLeftFoot},
      {LabelsOf("L_ground_force_v", "L_ground_force_p", "L_ground_torque_"), WrenchBody::kLeftFoot},
      {LabelsOf("Left_Hand_force_f", "Left_Hand_point_", "Left_Hand_torque_"),
       WrenchBody::kLeftHand},
      {LabelsOf("hand_r_force_v", "hand_r_force_p", "hand_r_torque_"), WrenchBody::kRightHand}};
  for (const auto& [labels, body] : expected) {
    const auto rows =
        ReadRows("x\nendheader\ntime" + labels + "\n0" + values + "\n", WrenchFormat::kMot);
    ASSERT_EQ(rows.size(), 1U) << labels;
    EXPECT_EQ(rows[0].body, body) << labels;
  }
}

TEST(WrenchReader, ListsTheGroupsAndTheRemedyIfABodyIsUnknown) {
  const std::string text =
      "x\nendheader\ntime" + LabelsOf("ground_force_v", "ground_force_p", "ground_torque_") +
      LabelsOf("1_ground_force_v", "1_ground_force_p", "1_ground_torque_") + "\n";
  EXPECT_THAT(MotError(text),
              AllOf(StartsWith("forces.mot: unknown on which body 'ground_force' acts"),
                    HasSubstr("--wrench_bodies ground_force=BODY"),
                    HasSubstr("Groups of the file: ground_force, 1_ground_force")));
  WrenchSettings settings = RightFootOf("ground_force");
  EXPECT_THAT(MotError(text, settings), HasSubstr("'1_ground_force'"));
  settings.groups.push_back({"1_ground_force", WrenchBody::kRightFoot});
  EXPECT_THAT(MotError(text, settings), HasSubstr("are both of RightFoot"));
  settings.groups[1].body = WrenchBody::kLeftFoot;
  EXPECT_EQ(MotError(text, settings), "accepted");
  settings.groups.push_back({"ground_force_3", WrenchBody::kLeftHand});
  EXPECT_THAT(MotError(text, settings),
              HasSubstr("no group 'ground_force_3' in forces.mot; its groups: ground_force, 1_"));
}

// A name with words that are not those of a foot is no foot, however it is sided.
TEST(WrenchReader, DoesNotGuessTheBody) {
  EXPECT_THAT(MotError("x\nendheader\ntime" +
                       LabelsOf("femur_r_force_v", "femur_r_force_p", "femur_r_torque_") + "\n"),
              HasSubstr("unknown on which body 'femur_r_force' acts"));
}

TEST(WrenchReader, LeavesOutAGroupOfNoBody) {
  WrenchSettings settings = RightFootOf("ground_force_1");
  settings.groups[0].body.reset();
  EXPECT_TRUE(ReadRows(std::string(kMotStart) + kMotLabels + "0 0 1 0 0 0 0 0 0 0\n",
                       WrenchFormat::kMot, settings)
                  .empty());
}

TEST(WrenchReader, ShiftsTurnsAndPlacesTheRows) {
  WrenchSettings settings;
  settings.offset_secs = 2.5;
  settings.place = {1, 2, M_PI / 2};
  const auto rows = ReadCsv("0,Ground,1,2,3,0.5,0.25,0.1,4,5,6\n", settings);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].secs, 2.5);
  EXPECT_TRUE(rows[0].force.isApprox(Vector3d(-2, 1, 3)));
  EXPECT_TRUE(rows[0].point->isApprox(Vector3d(0.75, 2.5, 0.1)));
  EXPECT_TRUE(rows[0].torque.isApprox(Vector3d(-5, 4, 6)));
}

TEST(WrenchReader, TurnsTheForceOnThePlateButNotThatOnAHand) {
  const std::string rows = "0,Ground,10,-20,-700,0,0,0,1,2,3\n0,LeftHand,0,0,-50,,,,0,0,0\n";
  EXPECT_THAT(ErrorOf([&] { ReadCsv(rows); }),
              AllOf(StartsWith("forces.csv: line 2: the vertical force on Ground is -700 N"),
                    HasSubstr("--wrench_sign on_plate")));
  WrenchSettings settings;
  settings.is_on_plate = true;
  const auto turned = ReadCsv(rows, settings);
  EXPECT_EQ(turned[0].force, Vector3d(-10, 20, 700));
  EXPECT_EQ(turned[0].torque, Vector3d(-1, -2, -3));
  EXPECT_EQ(turned[1].force, Vector3d(0, 0, -50));
}

TEST(WrenchReader, RefusesBadRowsWithLineValueAndExpectation) {
  const std::map<std::string, std::string> errors = {
      {"0,Ground,0,0,700,0,0,0,0,0\n", "line 2: 10 cells; expected 11"},
      {"0,Ground,0,0,700,5,0,0,0,0,0,0\n", "line 2: 12 cells; expected 11"},
      {"0,Ground,0,0,seven,0,0,0,0,0,0\n", "line 2: column fz_N: 'seven': expected a number"},
      {"0,Ground,0,0,,0,0,0,0,0,0\n", "line 2: column fz_N: '': expected a number"},
      {"0,Ground,0,0,nan,0,0,0,0,0,0\n", "line 2: column fz_N: 'nan': expected a number"},
      {"0,Ground,0,0,-inf,0,0,0,0,0,0\n", "line 2: column fz_N: '-inf': expected a number"},
      {"0,Ground,0,0,1e999,0,0,0,0,0,0\n", "line 2: column fz_N: '1e999': expected a number"},
      {"0,Ground,0,0,700x,0,0,0,0,0,0\n", "line 2: column fz_N: '700x': expected a number"},
      {"0,Ground,0,0,100001,0,0,0,0,0,0\n", "'100001': expected -100000 to 100000; check the unit"},
      {"0,Ground,0,0,700,1001,0,0,0,0,0\n", "column px_m: '1001': expected -1000 to 1000"},
      {"0,Ground,0,0,700,0,,0,0,0,0\n", "line 2: column py_m: '': expected a number"},
      {"0,Ground,0,0,700,0,0,0,0,0,1e6\n", "column tz_Nm: '1e6': expected"},
      {"1e9,Ground,0,0,700,0,0,0,0,0,0\n", "column time_s: '1e9': expected"},
      {"0,Foot,0,0,700,0,0,0,0,0,0\n", "line 2: column body: 'Foot': expected RightFoot, LeftFoot"},
      {"0,RightFoot,0,0,700,,,,0,0,0\n", "RightFoot has a vertical force of 700 N and no point"},
      {"1,Ground,0,0,0,0,0,0,0,0,0\n0,Ground,0,0,0,0,0,0,0,0,0\n",
       "line 3: time_s goes back from 1 to 0"},
      {"1,Ground,0,0,0,0,0,0,0,0,0\n1,Ground,0,0,0,0,0,0,0,0,0\n",
       "line 3: a second row of Ground at 1 s"},
      {std::string(1, '\0') + "\xff\x01,,,\n", "line 2: 4 cells; expected 11"}};
  for (const auto& [rows, expected] : errors) {
    EXPECT_THAT(ErrorOf([&, text = rows] { ReadCsv(text); }),
                AllOf(StartsWith("forces.csv: "), HasSubstr(expected)))
        << rows;
  }
}

TEST(WrenchReader, RefusesFilesWithoutTheirHeader) {
  const auto error = [](const std::string& text) {
    return ErrorOf([&] { ReadRows(text, WrenchFormat::kCsv); });
  };
  EXPECT_THAT(error(""),
              HasSubstr("forces.csv: the file is empty; expected the header time_s,body"));
  EXPECT_THAT(error("0,Ground,0,0,700,0,0,0,0,0,0\n"),
              HasSubstr("line 1: '0,Ground,0,0,700,0,0,0,0,0,0': column time_s is missing"));
  EXPECT_THAT(error("time_s;body;fx_N\n"), HasSubstr("column time_s is missing"));
  EXPECT_THAT(error("time_s,body,fx_N,fy_N,fz_N,px_m,py_m,pz_m,tx_Nm,ty_Nm\n"),
              HasSubstr("column tz_Nm is missing"));
  std::string wider = kHeader;
  wider.insert(wider.size() - 1, ",note");
  EXPECT_THAT(error(wider), HasSubstr("line 1: 12 columns; expected the header time_s,body"));
}

TEST(WrenchReader, TakesNoMemoryForALineWithoutEnd) {
  const std::string endless(10'000'000, '7');
  EXPECT_THAT(ErrorOf([&] { ReadRows(endless, WrenchFormat::kCsv); }),
              HasSubstr("forces.csv: line 1: longer than 16384 bytes"));
  EXPECT_THAT(ErrorOf([&] { ReadCsv("0,Ground," + endless); }),
              HasSubstr("forces.csv: line 2: longer than 16384 bytes"));
}

TEST(WrenchReader, RefusesAMotFileThatIsNotWhatItsHeaderSays) {
  const WrenchSettings right = RightFootOf("ground_force_1");
  const std::string start = kMotStart, labels = kMotLabels, row = " 0 1 0 0 0 0 0 0 0\n";
  EXPECT_EQ(MotError(start + labels + "0" + row, right), "accepted");
  EXPECT_THAT(MotError(start + labels, right),
              HasSubstr("forces.mot: 0 rows; expected 1, as nRows says"));
  EXPECT_THAT(MotError(start + labels + "0" + row + "1" + row, right),
              HasSubstr("line 9: more rows than the 1 that nRows says"));
  EXPECT_THAT(MotError("nColumns=9\nendheader\n" + labels, right),
              HasSubstr("line 3: 10 labels; expected 9, as nColumns says"));
  EXPECT_THAT(MotError("nRows=99999999999999999999\nendheader\n", right),
              HasSubstr("line 1: nRows: '99999999999999999999': expected a whole number"));
  EXPECT_THAT(MotError("DataType=Quaternion\nendheader\n", right),
              HasSubstr("DataType='Quaternion': expected double"));
  EXPECT_THAT(MotError("", right), HasSubstr("forces.mot: the file is empty"));
  EXPECT_THAT(MotError(std::string("\0\1\2\3\n\n", 6), right),
              HasSubstr("forces.mot: no line endheader"));
  EXPECT_THAT(MotError("endheader\n", right), HasSubstr("no labels after endheader"));
  EXPECT_THAT(MotError("endheader\nTime x\n", right),
              HasSubstr("the first label is 'Time': expected time"));
  EXPECT_THAT(MotError("endheader\ntime\n", right), HasSubstr("no columns beside time"));
  EXPECT_THAT(MotError("endheader\ntime knee_angle\n", right),
              HasSubstr("label 'knee_angle': expected columns of a force"));
  EXPECT_THAT(
      MotError("endheader\ntime a_vx a_vy a_vz a_px a_py a_pz a_torque_x a_torque_y\n", right),
      HasSubstr("'a': z of its torque is missing"));
  EXPECT_THAT(MotError("endheader\ntime a_vx a_fx\n", right),
              HasSubstr("label 'a_fx' stands for a column that is there already: 'a_vx'"));
  EXPECT_THAT(MotError(start + labels + "0 0 1 0 0 0 0 0 0\n", right),
              HasSubstr("line 8: 9 cells; expected 10"));
  EXPECT_THAT(MotError(start + labels + "0 0 NaN 0 0 0 0 0 0 0\n", right),
              HasSubstr("line 8: column ground_force_1_vy: 'NaN': expected a number"));
  EXPECT_THAT(MotError("endheader\n" + labels + "1" + row + "1" + row, right),
              HasSubstr("line 4: time 1 after 1"));
  EXPECT_THAT(MotError(start + labels + "0 0 -800 0 0 0 0 0 0 0\n", right),
              HasSubstr("line 8: the vertical force on RightFoot is -800 N"));
}

TEST(WrenchReader, TellsTheFormatByTheEndingBeforeThatOfAnArchive) {
  EXPECT_EQ(WrenchFormatOf("a/b.csv"), WrenchFormat::kCsv);
  EXPECT_EQ(WrenchFormatOf("b.mot.gz"), WrenchFormat::kMot);
  EXPECT_EQ(WrenchFormatOf("b.sto"), WrenchFormat::kMot);
  EXPECT_THAT(ErrorOf([] { WrenchFormatOf("b.c3d"); }),
              HasSubstr("b.c3d: unknown kind of file; expected the ending .csv, .mot or .sto"));
}

TEST(WrenchReader, RefusesNamesOfBodiesForAFileThatHasThem) {
  EXPECT_THAT(ErrorOf([] { ReadCsv("", RightFootOf("ground_force_1")); }),
              HasSubstr("--wrench_bodies: has no effect with a CSV file"));
}

}  // namespace
}  // namespace kinescope::wrenches
