// `kinescope render` as people use it: several files at once, again, interrupted, on a full disk,
// and checked afterwards.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "render/image/compare.h"
#include "render/image/png_file.h"
#include "render/renderer.h"
#include "render/video.h"
#include "server/app/render/provenance_comparison.h"
#include "server/app/render/provenance_files.h"
#include "server/app/render/render_options.h"
#include "server/picture/render_planner.h"
#include "server/scene/scene_reader.h"
#include "tests/process.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"
#include "tests/urdf/mesh_samples.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Kinescope;
using testing::ProgramResult;
using testing::ReadFile;
using testing::RunProgram;
using testing::TempFolder;
using Json = nlohmann::json;

class RenderCommand : public ::testing::Test {
 protected:
  // Small pictures of the walker, unless `arguments` say otherwise.
  ProgramResult Render(std::vector<std::string> arguments, const std::string& source = "demo:walk",
                       const std::vector<std::string>& before = {}) {
    std::vector<std::string> command = before;
    command.insert(command.end(),
                   {testing::KinescopePath(), "render", source, "--supersample", "1"});
    if (std::find(arguments.begin(), arguments.end(), "--size") == arguments.end()) {
      command.insert(command.end(), {"--size", "160x96"});
    }
    command.insert(command.end(), arguments.begin(), arguments.end());
    return RunProgram(command);
  }

  ProgramResult Verify(const std::string& file) {
    return Kinescope({"render", "--json", "--verify", file});
  }

  std::string Path(const std::string& name) const { return folder_ / name; }

  static std::vector<Json> Lines(const ProgramResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<Json> lines;
    std::istringstream in(result.out);
    for (std::string line; std::getline(in, line);) lines.push_back(Json::parse(line));
    return lines;
  }

  static std::vector<render::Image> Decode(const std::string& path) {
    const auto video = render::OpenVideo(path);
    std::vector<render::Image> pictures(1);
    while (video->Next(pictures.back())) pictures.emplace_back();
    pictures.pop_back();
    return pictures;
  }

  TempFolder folder_;
};

TEST_F(RenderCommand, WritesEveryFormatAndCameraInOnePass) {
  const auto lines =
      Lines(Render({"--out", Path("{camera}.mp4"), "--out", Path("{camera}.webm"), "--out",
                    Path("{source}-{camera}.png"), "--out", Path("{camera}-%02d.png"), "--camera",
                    "front,top", "--start", "0.5", "--seconds", "0.1", "--time", "0.3", "--json"}));
  EXPECT_EQ(lines.size(), 8u);
  for (const Json& line : lines) {
    const bool is_still = line.at("out").get<std::string>().find("demo_walk") != std::string::npos;
    EXPECT_EQ(line.at("pictures"), is_still ? 1 : 3) << line;
  }
  EXPECT_THAT(
      folder_.Names(),
      ElementsAre("demo_walk-front.png", "demo_walk-front.png.json", "demo_walk-top.png",
                  "demo_walk-top.png.json", "front-%02d.png.json", "front-00.png", "front-01.png",
                  "front-02.png", "front.mp4", "front.mp4.json", "front.webm", "front.webm.json",
                  "top-%02d.png.json", "top-00.png", "top-01.png", "top-02.png", "top.mp4",
                  "top.mp4.json", "top.webm", "top.webm.json"));
  EXPECT_FALSE(
      render::Compare(render::ReadPng(Path("front-01.png")), render::ReadPng(Path("top-01.png")))
          .equal());
  EXPECT_EQ(Decode(Path("top.webm")).size(), 3u);
}

TEST_F(RenderCommand, TakesCameraAndBackgroundFromAConfigurationOfRviz) {
  std::ofstream(Path("lab.rviz")) << "Visualization Manager:\n"
                                     "  Displays:\n"
                                     "    - {Class: rviz/RobotModel, Enabled: true, Name: Person}\n"
                                     "    - {Class: rviz/Path, Enabled: true, Name: Plan}\n"
                                     "  Global Options: {Background Color: 10; 20; 30}\n"
                                     "  Views: {Current: {Class: rviz/TopDownOrtho, Scale: 40}}\n";
  const ProgramResult taken =
      Render({"--rviz", Path("lab.rviz"), "--time", "0", "--no_overlays", "--out", Path("a.png")});
  ASSERT_EQ(taken.exit_code, 0) << taken.err;
  EXPECT_THAT(taken.err, HasSubstr("lab.rviz:4: rviz/Path 'Plan' is not drawn"));
  const render::Image picture = render::ReadPng(Path("a.png"));
  EXPECT_THAT(std::vector<std::uint8_t>(picture.rgba.begin(), picture.rgba.begin() + 3),
              ElementsAre(10, 20, 30));
  const Json options = Json::parse(ReadFile(Path("a.png.json"))).at("options");
  EXPECT_EQ(options.at("projection"), "orthographic");
  EXPECT_EQ(options.at("figure"), "urdf");

  const ProgramResult own = Render({"--rviz", Path("lab.rviz"), "--time", "0", "--camera", "front",
                                    "--figure", "skin", "--out", Path("b.png")});
  ASSERT_EQ(own.exit_code, 0) << own.err;
  const Json ours = Json::parse(ReadFile(Path("b.png.json"))).at("options");
  EXPECT_EQ(ours.at("camera"), "front");
  EXPECT_EQ(ours.at("projection"), "perspective") << "that of the file is of its own camera";
  EXPECT_EQ(ours.at("figure"), "skin");
}

TEST_F(RenderCommand, WritesTheSameBytesWithAnyNumberOfJobs) {
  for (const std::string jobs : {"1", "3"}) {
    const auto lines =
        Lines(Render({"--out", Path(jobs + ".mp4"), "--out", Path(jobs + ".webm"), "--out",
                      Path(jobs + "-%02d.png"), "--seconds", "0.5", "--jobs", jobs, "--json"}));
    EXPECT_EQ(lines.at(0).at("drawn"), 15);
  }
  for (const char* name : {".mp4", ".webm", "-00.png", "-07.png", "-14.png"}) {
    EXPECT_EQ(ReadFile(Path(std::string("1") + name)), ReadFile(Path(std::string("3") + name)))
        << name;
  }
}

// What picture k of the decoded clip looks like is the scene at k / fps, and not the one before or
// after it.
TEST_F(RenderCommand, ShowsTheTimeOfEachFrameNumberDividedByTheFrameRate) {
  Lines(Render({"--out", Path("a.mp4"), "--fps", "29.97", "--seconds", "0.5", "--camera", "right",
                "--no_overlays", "--fit", "off", "--size", "320x240", "--json"}));
  const std::vector<render::Image> clip = Decode(Path("a.mp4"));
  ASSERT_EQ(clip.size(), 15u);

  app::SceneReader reader("demo:walk", {});
  app::SceneTimeline timeline(reader);
  app::ViewOptions view;
  view.size = {320, 240};
  view.camera.Parse("right");
  view.supersample = 1;
  view.no_overlays = true;
  view.moves.fit = app::Fit::kOff;
  app::RenderPlanner planner(view);
  const auto renderer = render::MakeRenderer();
  std::vector<render::Image> expected;
  std::int64_t first_nanos = 0;
  for (std::int64_t k = 0; k < 15; ++k) {
    const app::RenderRequest request = planner.Next(*timeline.AtNanos(k * 1001 * 1'000'000 / 30));
    if (k == 0) first_nanos = request.state.stamp_nanos;
    EXPECT_NEAR(static_cast<double>(request.state.stamp_nanos - first_nanos) * 1e-9,
                static_cast<double>(k) * 1001 / 30000, 2e-9);
    expected.push_back(renderer->Render(request.state, request.camera, request.spec));
  }
  const auto difference = [&](std::size_t shown, std::size_t drawn) {
    return render::Compare(expected[drawn], clip[shown], 24).pixels;
  };
  for (std::size_t k = 1; k + 1 < clip.size(); ++k) {
    EXPECT_LT(difference(k, k), difference(k, k - 1)) << "picture " << k << " comes too late";
    EXPECT_LT(difference(k, k), difference(k, k + 1)) << "picture " << k << " comes too early";
  }
}

TEST_F(RenderCommand, SkipsOutputsThatAreUpToDate) {
  const std::vector<std::string> command = {"--out",       Path("a.mp4"), "--out",
                                            Path("a.png"), "--out",       Path("%d.png"),
                                            "--seconds",   "0.1",         "--json"};
  const auto drawn = [&](std::vector<std::string> more = {}) {
    more.insert(more.end(), command.begin(), command.end());
    std::vector<long> counts;
    for (const Json& line : Lines(Render(more))) counts.push_back(line.at("drawn").get<long>());
    return counts;
  };
  EXPECT_THAT(drawn(), ElementsAre(3, 1, 3));
  EXPECT_THAT(drawn(), ElementsAre(0, 0, 0));
  fs::remove(Path("1.png"));
  std::ofstream(Path("a.mp4"), std::ios::app) << "damaged";
  EXPECT_THAT(drawn(), ElementsAre(3, 0, 1));
  EXPECT_THAT(drawn({"--title", "other"}), ElementsAre(3, 1, 3));
  EXPECT_THAT(drawn({"--title", "other", "--force"}), ElementsAre(3, 1, 3));
  // Other sources have other pictures, whatever their files are called.
  EXPECT_EQ(Lines(Render({"--out", Path("a.png"), "--json"}, "demo:lift")).at(0).at("drawn"), 1);
}

TEST_F(RenderCommand, ReadsProvenanceFromTheFilesIfSidecarsAreOff) {
  for (const long drawn : {3, 0}) {
    const auto lines = Lines(Render({"--out", Path("a.webm"), "--out", Path("a.webp"), "--out",
                                     Path("a.gif"), "--seconds", "0.1", "--no_sidecar", "--json"}));
    for (const Json& line : lines) EXPECT_EQ(line.at("drawn"), drawn) << line;
  }
  EXPECT_THAT(folder_.Names(), ElementsAre("a.gif", "a.webm", "a.webp"));
  EXPECT_EQ(Verify(Path("a.gif")).exit_code, 0);
}

TEST_F(RenderCommand, ResumesAnInterruptedRun) {
  const std::string pattern = Path("%04d.png");
  {
    testing::Process run({"/bin/bash", "-c",
                          "\"$0\" \"$@\" 2>&1 & child=$!; trap 'kill -INT $child' TERM; "
                          "wait $child; wait $child; echo code $?",
                          testing::KinescopePath(), "render", "demo:walk", "--size", "160x96",
                          "--supersample", "1", "--fit", "off", "--out", pattern, "--out",
                          Path("a.mp4"), "--seconds", "1000"});
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!fs::exists(Path("0003.png")) && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    ASSERT_TRUE(fs::exists(Path("0003.png")));
    run.Signal(SIGTERM);
    std::string said;
    while (const auto line = run.ReadLine(std::chrono::seconds(30))) said += *line + "\n";
    EXPECT_THAT(said, HasSubstr("interrupted; not finished"));
    EXPECT_THAT(said, HasSubstr("code 2"));
  }
  const std::vector<std::string> names = folder_.Names();
  for (const std::string& name : names) {
    EXPECT_EQ(name.size(), std::string("0003.png").size()) << name << " was left behind";
    EXPECT_NO_THROW(render::ReadPng(Path(name)));
  }
  const std::size_t wanted = names.size() + 4;
  const auto lines = Lines(Render({"--out", pattern, "--fit", "off", "--seconds",
                                   fmt::format("{}", static_cast<double>(wanted) / 30), "--json"}));
  EXPECT_EQ(lines.at(0).at("pictures"), wanted);
  EXPECT_LT(lines.at(0).at("drawn"), wanted);
  EXPECT_EQ(Verify(pattern).exit_code, 0);
}

TEST_F(RenderCommand, WritesProvenanceIntoTheFile) {
  Lines(Render({"--out", Path("a.png"), "--out", Path("a.mp4"), "--seconds", "0.1", "--time", "1.5",
                "--title", "trial <3>", "--hand_load", "both:5", "--json"}));
  const auto still = app::ReadEmbedded(Path("a.png"));
  ASSERT_TRUE(still);
  EXPECT_EQ(still->at("source").at("name"), "demo:walk");
  EXPECT_EQ(still->at("options").at("time"), 1.5);
  EXPECT_EQ(still->at("options").at("hand_load"), "both:5");
  EXPECT_FALSE(still->at("options").contains("fps"));
  EXPECT_EQ(still->at("camera").at("position_m").size(), 3u);
  EXPECT_THAT(still->at("renderer").get<std::string>(), HasSubstr("llvmpipe"));
  EXPECT_EQ(still->at("loads").at("class_ratios_up").size(), 2u);
  const auto clip = app::ReadEmbedded(Path("a.mp4"));
  ASSERT_TRUE(clip);
  EXPECT_EQ(clip->at("options").at("fps"), "30");
  EXPECT_TRUE(app::DecideTheSame(*clip, *app::ReadSidecar(Path("a.mp4"))));
}

TEST_F(RenderCommand, VerifiesItsFilesAndReportsDifferences) {
  Lines(Render({"--out", Path("a.png"), "--out", Path("a.mp4"), "--out", Path("%d.png"),
                "--seconds", "0.1", "--json"}));
  for (const char* name : {"a.png", "a.mp4", "%d.png", "2.png"}) {
    const ProgramResult result = Verify(Path(name));
    EXPECT_EQ(result.exit_code, 0) << name << ": " << result.out << result.err;
  }
  render::Image image = render::ReadPng(Path("a.png"));
  image.rgba[4 * 1000] = static_cast<std::uint8_t>(image.rgba[4 * 1000] ^ 1);
  render::WritePng(Path("a.png"), image, render::ReadPngText(Path("a.png")));
  const ProgramResult result = Verify(Path("a.png"));
  EXPECT_EQ(result.exit_code, 1) << "a pixel that is one level off was not seen";
  EXPECT_THAT(Json::parse(result.out).at("how").get<std::string>(), HasSubstr("1 pixel"));
  EXPECT_EQ(render::ReadPng(Path("a.png.diff.png")).width, image.width);

  app::Json lies = *app::ReadEmbedded(Path("2.png"));
  for (const auto& [key, value] : std::map<std::string, app::Json>{
           {"source", 3}, {"number", -1}, {"options", "none"}, {"kind", app::Json::array()}}) {
    app::Json lie = lies;
    lie[key] = value;
    render::WritePng(Path("lie.png"), image, {{app::kProvenanceKey, app::ToText(lie)}});
    EXPECT_EQ(Verify(Path("lie.png")).exit_code, 2) << key;
  }
  lies.erase("number");
  lies["kind"] = "picture";
  lies["format"] = "/../../stolen.png";
  render::WritePng(Path("lie.png"), image, {{app::kProvenanceKey, app::ToText(lies)}});
  const ProgramResult stolen = Verify(Path("lie.png"));
  EXPECT_EQ(stolen.exit_code, 2);
  EXPECT_THAT(stolen.err, HasSubstr("unknown format"));

  EXPECT_EQ(Verify(Path("missing.png")).exit_code, 2);
  render::WritePng(Path("bare.png"), image);
  const ProgramResult bare = Verify(Path("bare.png"));
  EXPECT_EQ(bare.exit_code, 2);
  EXPECT_THAT(bare.err, HasSubstr("contains no provenance"));
}

// The record of the first version: texts of all options, former names of options and words.
TEST_F(RenderCommand, VerifiesAPictureOfTheFirstVersion) {
  Lines(Render({"--out", Path("a.png"), "--sample", "30", "--overlay", "title,status,frame_code",
                "--show", "link_frames,joint_axes", "--body_model", "primitive", "--fit", "off",
                "--camera_frame", "world", "--no_sidecar", "--json"}));
  std::ofstream(Path("a.png.json")) << R"({
    "kinescope": "0.1.0", "schema": 1, "source": {"name": "demo:walk"}, "inputs": [],
    "renderer": ")" << app::ReadEmbedded(Path("a.png"))->value("renderer", "")
                                    << R"(",
    "kind": "picture", "format": "png",
    "options": {"frame": 30, "overlay_layer": "", "size": "160x96", "camera": "three_quarter",
      "views": "", "supersample": 1, "title": "", "overlay": "title,lamp,strip", "plot": "",
      "no_overlays": false, "show": "frames,axes", "figure": "primitive", "robot": "", "hand": "",
      "class_limits": "0.3,0.6", "lumbar_compression": "on"}})";
  const ProgramResult result = Verify(Path("a.png"));
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(RenderCommand, VerifiesOneFrameOfASequenceWithAPlotOfTheWholeSequence) {
  Lines(Render({"--out", Path("%d.png"), "--seconds", "0.2", "--plot", "l5_s1", "--size", "320x192",
                "--json"}));
  const ProgramResult result = Verify(Path("2.png"));
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

// Pixels per metre in the chunk pHYs of a PNG; 0 without one.
long PixelsPerMetreIn(const std::string& png) {
  const std::size_t at = png.find("pHYs");
  if (at == std::string::npos) return 0;
  long value = 0;
  for (std::size_t i = 4; i < 8; ++i) value = 256 * value + static_cast<unsigned char>(png[at + i]);
  return value;
}

// Of the words that poppler finds in a PDF.
struct PdfWords {
  int count = 0;
  double least_pt = 1e9;  // size of their font
  double page_width_pt = 0, page_height_pt = 0;
};

// xMax="12.5" in a line of pdftotext.
double ValueIn(const std::string& line, const std::string& name) {
  const std::size_t at = line.find(name + "=\"");
  return at == std::string::npos ? NAN : std::stod(line.substr(at + name.size() + 2));
}

PdfWords WordsOfPdf(const std::string& path) {
  const ProgramResult words = RunProgram({"/usr/bin/pdftotext", "-bbox", path, "-"});
  EXPECT_EQ(words.exit_code, 0) << words.err;
  PdfWords found;
  std::istringstream lines(words.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("<page") != std::string::npos) {
      found.page_width_pt = ValueIn(line, "width");
      found.page_height_pt = ValueIn(line, "height");
    }
    if (line.find("<word") == std::string::npos) continue;
    constexpr double kBox = 1.164;  // of DejaVu Sans: ascent and descent, em
    found.least_pt =
        std::min(found.least_pt, (ValueIn(line, "yMax") - ValueIn(line, "yMin")) / kBox);
    ++found.count;
  }
  return found;
}

constexpr double kSmallestPt = 7;

TEST_F(RenderCommand, MakesAFigureOfAWidthInPrintWithReadableTexts) {
  for (const char* dpi : {"150", "300", "1200"}) {
    Lines(Render({"--out", Path("a.png"), "--size", "1280x720", "--width_mm", "80", "--dpi", dpi,
                  "--title", "Lifting", "--overlay", "+scale,+plot", "--plot", "l5_s1",
                  "--overlay_layer", "pdf", "--json"},
                 "demo:lift"));
    const render::Image image = render::ReadPng(Path("a.png"));
    EXPECT_EQ(image.width, std::lround(80 / 25.4 * std::stod(dpi)));
    EXPECT_NEAR(image.height, image.width * 720.0 / 1280, 1);
    EXPECT_NEAR(static_cast<double>(PixelsPerMetreIn(ReadFile(Path("a.png")))), image.width / 0.080,
                0.5);
    const PdfWords words = WordsOfPdf(Path("a.pdf"));
    EXPECT_NEAR(words.page_width_pt, 80 / 25.4 * 72, 0.01);
    EXPECT_GE(words.least_pt, kSmallestPt - 0.01);
    EXPECT_GT(words.count, 10);
  }
}

TEST_F(RenderCommand, PrintsThePlotsNumbersAsLargeAsOtherTexts) {
  const std::vector<std::string> figure = {"--out",     Path("a.png"),     "--force", "--size",
                                           "1200x1050", "--width_mm",      "80",      "--dpi",
                                           "100",       "--overlay_layer", "pdf",     "--json"};
  Lines(Render(figure, "demo:lift"));
  const int without = WordsOfPdf(Path("a.pdf")).count;
  std::vector<std::string> plotted = figure;
  plotted.insert(plotted.end(), {"--plot", "l5_s1,right_knee"});
  Lines(Render(plotted, "demo:lift"));
  const PdfWords words = WordsOfPdf(Path("a.pdf"));
  EXPECT_GT(words.count, without + 4) << "the plot is there";
  EXPECT_GE(words.least_pt, kSmallestPt - 0.01);
}

TEST_F(RenderCommand, EndsALongTitleBeforeTheStatus) {
  Lines(Render({"--out", Path("a.png"), "--size", "1280x720", "--width_mm", "80", "--dpi", "300",
                "--title", "Lifting a box of fourteen kilograms from the floor to a shelf",
                "--overlay_layer", "pdf", "--json"},
               "demo:lift"));
  const ProgramResult words = RunProgram({"/usr/bin/pdftotext", "-bbox", Path("a.pdf"), "-"});
  double end_of_title = NAN, begin_of_status = NAN;
  std::istringstream lines(words.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("…") != std::string::npos) end_of_title = ValueIn(line, "xMax");
    if (line.find("RECORDED") != std::string::npos) begin_of_status = ValueIn(line, "xMin");
  }
  EXPECT_LT(end_of_title + 5, begin_of_status) << words.out;
}

TEST_F(RenderCommand, MakesALayerOfTheLinesAloneWithoutOverlays) {
  Lines(Render({"--out", Path("a.png"), "--size", "640x480", "--style", "line", "--no_overlays",
                "--overlay_layer", "pdf", "--json"},
               "demo:lift"));
  EXPECT_EQ(WordsOfPdf(Path("a.pdf")).count, 0);
}

// The command of docs/pictures.md, on the page where its reader has it.
TEST_F(RenderCommand, MakesAJournalFigureWhoseTextsAreReadableOnAnA4Page) {
  Lines(Render({"--out", Path("figure.png"), "--views", "time:0,1.3,2.4", "--legend", "below",
                "--overlay", "legend", "--background", "white", "--size", "1200x1050", "--width_mm",
                "80", "--dpi", "300", "--overlay_layer", "pdf_page", "--json"},
               "demo:lift"));
  const PdfWords figure = WordsOfPdf(Path("figure.pdf"));
  EXPECT_NEAR(figure.page_width_pt, 80 / 25.4 * 72, 0.01);
  // As a printer places it: neither scaled nor turned.
  const ProgramResult printed = RunProgram({"/usr/bin/pdftocairo", "-pdf", "-paper", "A4",
                                            "-noshrink", Path("figure.pdf"), Path("a4.pdf")});
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  const PdfWords page = WordsOfPdf(Path("a4.pdf"));
  const auto [narrow, wide] = std::minmax(page.page_width_pt, page.page_height_pt);
  EXPECT_NEAR(narrow, 210 / 25.4 * 72, 1) << "upright or across";
  EXPECT_NEAR(wide, 297 / 25.4 * 72, 1);
  EXPECT_EQ(page.count, figure.count);
  EXPECT_GT(page.count, 15);
  EXPECT_GE(page.least_pt, kSmallestPt - 0.01);
  const ProgramResult text = RunProgram({"/usr/bin/pdftotext", Path("a4.pdf"), "-"});
  EXPECT_THAT(text.out, AllOf(HasSubstr("1.3 s"), HasSubstr("Joint load"), HasSubstr("unknown")));
  const ProgramResult images = RunProgram({"/usr/bin/pdfimages", "-list", Path("a4.pdf")});
  EXPECT_THAT(images.out, HasSubstr("945")) << "80 mm at 300 dpi: " << images.out;
  // The PNG beside it is the same figure.
  EXPECT_EQ(Verify(Path("figure.png")).exit_code, 0);
}

TEST_F(RenderCommand, ShowsSeveralMomentsAndVerifiesThem) {
  Lines(Render({"--out", Path("a.png"), "--views", "time:0,0.5/1", "--trail", "right_hand",
                "--overlay_layer", "svg", "--size", "480x360", "--legend", "outside", "--json"}));
  EXPECT_THAT(ReadFile(Path("a.svg")), HasSubstr("<svg"));
  const ProgramResult verified = Verify(Path("a.png"));
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  const auto error = [&](const std::vector<std::string>& more, const std::string& out) {
    std::vector<std::string> arguments = {"--out", Path(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = Render(arguments);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(error({"--views", "time:0,1"}, "b.mp4"),
              AllOf(HasSubstr("--views=time:0,1"), HasSubstr("one still picture")));
  EXPECT_THAT(error({"--views", "time:0,1", "--time", "2"}, "b.png"),
              HasSubstr("leave out --time"));
  EXPECT_FALSE(fs::exists(Path("b.png")));
}

TEST_F(RenderCommand, NamesAMomentAfterTheEndOfTheRecording) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const ProgramResult late = Render({"--out", Path("a.png"), "--views", "time:0,5000"},
                                    testing::SharedData("mvnx/test_mocap.mvnx"));
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_THAT(late.err, AllOf(HasSubstr("--views=time:0,5000"), HasSubstr("ends before 5000 s")));
}

TEST_F(RenderCommand, KeepsTheLegendBelowInClipsAndSequences) {
  Lines(Render({"--out", Path("a.mp4"), "--out", Path("%d.png"), "--seconds", "0.1", "--size",
                "320x240", "--legend", "below", "--trail", "right_hand", "--json"}));
  EXPECT_EQ(render::ReadPng(Path("0.png")).height, 240);
  EXPECT_EQ(Verify(Path("a.mp4")).exit_code, 0);
  EXPECT_EQ(Verify(Path("1.png")).exit_code, 0);
}

TEST_F(RenderCommand, KeepsTheSizeInPixelsWithAWidthInPrintAlone) {
  Lines(Render({"--out", Path("a.png"), "--size", "800x600", "--width_mm", "100", "--json"}));
  EXPECT_EQ(PixelsPerMetreIn(ReadFile(Path("a.png"))), 8000);
  EXPECT_EQ(render::ReadPng(Path("a.png")).width, 800);
  const ProgramResult verified = Verify(Path("a.png"));
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  Lines(Render({"--out", Path("b.png"), "--json"}));
  EXPECT_EQ(PixelsPerMetreIn(ReadFile(Path("b.png"))), 0);
}

TEST_F(RenderCommand, NamesAnImpossibleWidthInPrint) {
  const ProgramResult large =
      Render({"--out", Path("a.png"), "--width_mm", "1000", "--dpi", "1200"});
  EXPECT_EQ(large.exit_code, 2);
  EXPECT_THAT(large.err, AllOf(HasSubstr("--width_mm=1000"), HasSubstr("--dpi=1200"),
                               HasSubstr("47244 x"), HasSubstr("px each way")));
  const ProgramResult alone = Render({"--out", Path("a.png"), "--dpi", "300"});
  EXPECT_THAT(alone.err, AllOf(HasSubstr("dpi"), HasSubstr("without --width_mm")));
}

TEST_F(RenderCommand, NamesAMeshThatIsMissingOnce) {
  const std::string urdf = folder_ / "arm.urdf";
  std::ofstream(urdf) << "<robot name='arm'><link name='a'><visual><geometry><mesh "
                         "filename='package://nowhere/a.stl'/></geometry></visual></link></robot>";
  const ProgramResult result = Render({"--robot", urdf, "--time", "1", "--out", folder_ / "a.png"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string line = "mesh package://nowhere/a.stl: package 'nowhere' was not found";
  const std::size_t first = result.err.find(line);
  ASSERT_NE(first, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(line, first + 1), std::string::npos) << result.err;
}

TEST_F(RenderCommand, NamesAChangedFileWithInvalidUtf8) {
  std::ofstream(Path("tool.obj")) << "mtllib n\xFF.mtl\nv 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\n"
                                     "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  std::ofstream(Path("n\xFF.mtl")) << "newmtl red\nKd 1 0 0\n";
  Lines(Render({"--out", Path("a.png"), "--tool", "right:" + Path("tool.obj"), "--json"}));
  std::ofstream(Path("n\xFF.mtl")) << "newmtl green\nKd 0 1 0\n";
  const ProgramResult result = Verify(Path("a.png"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(
      result.err,
      AllOf(HasSubstr("a.png: an input file named in its options is missing or has changed"),
            HasSubstr("n\uFFFD.mtl")));
}

TEST_F(RenderCommand, ShowsTheLoadsOfMeasuredForcesAndVerifiesThemAgainstTheirFile) {
  const std::string forces = Path("forces.csv");
  const auto write = [&](const char* force) {
    std::ofstream(forces)
        << "time_s,body,fx_N,fy_N,fz_N,px_m,py_m,pz_m,tx_Nm,ty_Nm,tz_Nm\n0,LeftHand,0,0," << force
        << ",,,,0,0,0\n0.1,LeftHand,0,0," << force << ",,,,0,0,0\n";
  };
  write("-100");
  Lines(Render({"--out", Path("a.png"), "--time", "0.05", "--wrenches", forces, "--json"}));
  Lines(Render({"--out", Path("bare.png"), "--time", "0.05", "--json"}));
  EXPECT_NE(testing::ReadFile(Path("a.png")), testing::ReadFile(Path("bare.png")));
  EXPECT_EQ(Verify(Path("a.png")).exit_code, 0);
  write("-200");
  const ProgramResult changed = Verify(Path("a.png"));
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_THAT(changed.err, HasSubstr("forces.csv"));
  testing::ExpectRefusal(Kinescope({"render", "demo:lift", "demo:walk", "--wrenches", forces,
                                    "--out", Path("{source}.png")}),
                         "--wrenches=" + forces);
}

TEST_F(RenderCommand, VerifiesOnlyAgainstTheOriginalSource) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const std::string source = Path("take.mvnx"), moved = Path("moved.mvnx");
  fs::copy_file(testing::SharedData("mvnx/test_mocap.mvnx"), source);
  Lines(Render({"--out", Path("a.png"), "--sample", "60", "--json"}, source));
  EXPECT_EQ(Verify(Path("a.png")).exit_code, 0);
  fs::rename(source, moved);
  const ProgramResult gone = Verify(Path("a.png"));
  EXPECT_EQ(gone.exit_code, 2);
  EXPECT_THAT(gone.err, HasSubstr("take.mvnx"));
  EXPECT_EQ(Kinescope({"render", moved, "--verify", Path("a.png")}).exit_code, 0);
  std::ofstream(moved, std::ios::app) << "\n";
  const ProgramResult other = Kinescope({"render", moved, "--verify", Path("a.png")});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("SHA-256"));
}

TEST_F(RenderCommand, LeavesNoFilesOnAFullDisk) {
  for (const char* name : {"a.mp4", "a.webm", "a.webp", "a.gif", "a.png"}) {
    const bool is_still = fs::path(name).extension() == ".png";
    const ProgramResult result =
        Render({"--out", Path(name), "--size", "640x480", is_still ? "--time" : "--seconds", "0.6"},
               "demo:walk", {"/usr/bin/prlimit", "--fsize=8192"});
    EXPECT_EQ(result.exit_code, 2) << name;
    EXPECT_THAT(result.err, HasSubstr(name));
    EXPECT_THAT(folder_.Names(), IsEmpty()) << name;
  }
}

TEST_F(RenderCommand, RejectsInvalidOptionsBeforeReadingTheSource) {
  struct Case {
    std::vector<std::string> arguments;
    const char* named;
  };
  const std::string out = Path("a.mp4");
  const std::vector<Case> cases = {{{"--out", out, "--size", "1000000x1000000"}, "1000000"},
                                   {{"--out", out, "--size", "161x97"}, "161 x 97"},
                                   {{"--out", out, "--fps", "nan"}, "--fps=nan"},
                                   {{"--out", out, "--jobs", "-1"}, "--jobs=-1"},
                                   {{"--out", out, "--camera", "sideways"}, "sideways"},
                                   {{"--out", out, "--crf", "52"}, "52"},
                                   {{"--out", Path("a.gif"), "--fps", "60"}, "at most 50"},
                                   {{"--out", "/proc/a.png"}, "/proc/a.png"}};
  for (const Case& each : cases) {
    const ProgramResult result = Render(each.arguments);
    EXPECT_EQ(result.exit_code, 2) << each.named << ": " << result.out;
    EXPECT_THAT(result.err, HasSubstr(each.named));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
  EXPECT_THAT(folder_.Names(), IsEmpty());
}

TEST_F(RenderCommand, WritesTheRequestedFormatAccordingToFfprobe) {
  if (std::system("command -v ffprobe >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffprobe here";
  Lines(Render({"--out", Path("a.mp4"), "--out", Path("a.webm"), "--fps", "30000/1001", "--seconds",
                "1", "--json"}));
  for (const char* name : {"a.mp4", "a.webm"}) {
    const ProgramResult probe = RunProgram(
        {"/usr/bin/env", "ffprobe", "-v", "error", "-count_frames", "-show_entries",
         "stream=width,height,pix_fmt,color_range,color_space,color_transfer,color_primaries,"
         "r_frame_rate,avg_frame_rate,nb_read_frames",
         "-of", "csv=p=0", Path(name)});
    EXPECT_EQ(probe.out, "160,96,yuv420p,tv,bt709,bt709,bt709,30000/1001,30000/1001,30\n") << name;
  }
}

}  // namespace
}  // namespace kinescope
