#include "server/app/render/provenance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <tuple>

#include "core/system/errors.h"
#include "server/app/render/provenance_comparison.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

Json Sample(const RenderOptions& options, const std::string& source = "demo:lift") {
  const render::RendererInfo renderer{"osmesa", "a renderer", "4.5", true, ""};
  return Provenance(options, source, renderer).Of({"a.mp4", OutputKind::kClip, "top"});
}

TEST(Provenance, NamesTheEncodingSoThatClipsOfEarlierVersionsCanBeMadeAgain) {
  Json clip = Sample(RenderOptions());
  EXPECT_EQ(clip.at("encoding"), render::kClipEncoding);
  EXPECT_EQ(OptionsOf(clip, "b.mp4").pack.encoding, render::kClipEncoding);
  clip.erase("encoding");
  EXPECT_EQ(OptionsOf(clip, "b.mp4").pack.encoding, 1);
  for (const int unknown : {0, render::kClipEncoding + 1}) {
    clip["encoding"] = unknown;
    EXPECT_THROW(OptionsOf(clip, "b.mp4"), std::runtime_error) << unknown;
  }
}

TEST(Provenance, RestoresTheOptionsOfItsPicture) {
  const auto options = testing::With<RenderOptions>({{"fps", "30000/1001"},
                                                     {"start", "0.1"},
                                                     {"end", "2.000000000000001"},
                                                     {"crf", "0"},
                                                     {"title", "Prüfung \"3\"\n"},
                                                     {"no_overlays", "true"},
                                                     {"mass", "61.3"},
                                                     {"hand_load", "both:5"}});
  const Json first = Sample(options);
  const auto read = FromText(ToText(first));
  ASSERT_TRUE(read);
  const RenderOptions again = OptionsOf(*read, "b.mp4");
  EXPECT_EQ(*again.clip.end, *options.clip.end);
  EXPECT_EQ(*again.view.title, *options.view.title);
  EXPECT_EQ(again.view.camera.ToText(), "top");
  EXPECT_EQ(*again.outs, std::vector<std::string>{"b.mp4"});
  EXPECT_TRUE(DecideTheSame(first, Sample(again)));
  // What a file can carry anywhere: a PNG's text is Latin-1, a GIF's comment bytes.
  for (const char c : ToText(first)) EXPECT_GE(c, ' ');
}

// A .gif says the quality that was asked for, too; drawn again, nobody asks for it.
TEST(Provenance, RestoresTheQualityOnlyForFormatsWithAQuality) {
  const auto options = testing::With<RenderOptions>({{"quality", "50"}});
  const render::RendererInfo renderer{"osmesa", "a renderer", "4.5", true, ""};
  for (const std::string out : {"a.webp", "a.gif"}) {
    const Json json =
        Provenance(options, "demo:lift", renderer).Of({out, OutputKind::kClip, "top"});
    EXPECT_EQ(*OptionsOf(json, out).pack.quality, out == "a.webp" ? 50 : *PackOptions().quality);
  }
}

TEST(Provenance, DiffersForEveryOptionThatChangesAPixelAndForNoOther) {
  const RenderOptions plain;
  const auto differs = [&](const char* name, const char* text) {
    return !DecideTheSame(Sample(plain), Sample(testing::With<RenderOptions>({{name, text}})));
  };
  EXPECT_TRUE(differs("fps", "25"));
  EXPECT_TRUE(differs("size", "640x480"));
  EXPECT_TRUE(differs("sex", "female"));
  EXPECT_TRUE(differs("capacity_factor", "0.9"));
  EXPECT_TRUE(differs("crf", "20"));
  EXPECT_FALSE(differs("jobs", "7"));
  EXPECT_FALSE(differs("force", "true"));
  EXPECT_FALSE(differs("json", "true"));
  EXPECT_FALSE(differs("quality", "3")) << "only .webp has it";
  EXPECT_FALSE(differs("sample", "3")) << "a clip has no moment";
}

TEST(Provenance, ContainsTheHashesOfTheSourceAndOfInputFiles) {
  const testing::TempFolder folder;
  std::ofstream(folder / "take.mvnx") << "abc";
  std::filesystem::create_directory(folder / "meshes");
  std::ofstream(folder / "meshes" / "Head.stl") << "solid";
  const auto options =
      testing::With<RenderOptions>({{"body_model", "mesh:" + (folder / "meshes").string()}});
  const Json first = Sample(options, folder / "take.mvnx");
  EXPECT_EQ(first.at("source").at("name"), "take.mvnx");
  EXPECT_EQ(first.at("source").at("sha256"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  ASSERT_EQ(first.at("inputs").size(), 1u) << first.at("inputs");
  EXPECT_EQ(first.at("inputs").at(0).at("name"), "Head.stl");
  std::ofstream(folder / "meshes" / "Head.stl") << "another";
  EXPECT_FALSE(DecideTheSame(first, Sample(options, folder / "take.mvnx")));
}

TEST(Provenance, ChangesWithTheFilesOfRobotsReferencePosesAndRigs) {
  const testing::TempFolder folder;
  const std::string urdf = folder / "r.urdf", ghost = folder / "take.mvnx",
                    glb = folder / "person.glb";
  std::ofstream(glb) << "before";
  std::ofstream(urdf) << "<robot name='before'><link name='a'/></robot>";
  std::ofstream(ghost) << "before";
  for (const auto& [name, text, file] :
       {std::tuple("robot", urdf + "@1,0", urdf), std::tuple("ghost", ghost + "@2", ghost),
        std::tuple("figure", "skin:" + glb, glb)}) {
    const auto options = testing::With<RenderOptions>({{name, text}});
    const Json first = Sample(options);
    ASSERT_EQ(first.at("inputs").size(), 1u) << first.at("inputs");
    std::ofstream(file) << "<robot name='after'><link name='a'/></robot>";
    EXPECT_FALSE(DecideTheSame(first, Sample(options))) << name;
  }
}

TEST(Provenance, KeepsFileNamesThatContainTheListSeparator) {
  const testing::TempFolder folder;
  const std::string first = folder / "a;b.urdf", second = folder / "c.urdf";
  for (const std::string& file : {first, second}) {
    std::ofstream(file) << "<robot name='r'><link name='a'/></robot>";
  }
  RenderOptions options;
  options.view.robot.ParseAll({first + "@1,0", second});
  const Json json = Sample(options);
  const RenderOptions again = OptionsOf(FromText(ToText(json)).value(), "a.mp4");
  ASSERT_EQ(again.view.robot->size(), 2u);
  EXPECT_EQ(again.view.robot->at(0).file, first);
  EXPECT_EQ(again.view.robot->at(0).place->x, 1);
  EXPECT_TRUE(DecideTheSame(json, Sample(again)));
}

// As version 0.1.0 wrote it first: texts of all options, "" for those not given, former names.
Json SchemaOne(const Json& options, const Json& inputs = Json::array()) {
  Json json = Json::parse(R"({
    "kinescope": "0.1.0", "schema": 1, "source": {"name": "demo:lift"}, "inputs": [],
    "renderer": "a renderer", "gl_version": "4.5", "backend": "osmesa", "backend_note": "",
    "kind": "picture", "format": "png",
    "options": {
      "frame": 100, "overlay_layer": "", "size": "320x180", "camera": "three_quarter", "views": "",
      "projection": "perspective", "orbit": "0", "fit": "off", "supersample": 2, "title": "",
      "overlay": "", "plot": "", "no_overlays": false, "theme": "light", "background": "theme",
      "floor": "on", "show": "", "hide": "", "trail": "", "trail_secs": 2.0, "ghost": "",
      "ghost_opacity": 0.35, "robot": "", "model_name": "skeleton", "body_table": "de_leva",
      "extra_mass": "", "figure": "smooth", "tool": "", "mesh_units": "m", "mesh_up": "z",
      "mesh_scale": "fit", "mesh_frame": "auto", "capacity_factor": 1.0,
      "capacity_percentile": "50", "load_metric": "total", "load_mode": "dynamic",
      "class_limits": "0.3,0.6", "hand": "", "filter_hz": 5.0, "lumbar_compression": "on"}})");
  if (options.is_object()) json["options"].update(options);
  json["inputs"] = inputs;
  return json;
}

// Options as the command line gives them, for comparison.
std::string OptionText(const RenderOptions& options, const std::string& name) {
  RenderOptions copy = options;
  options::OptionList list;
  copy.List(list);
  return list.Find(name)->value->ToText();
}

TEST(Provenance, ReadsTheFirstSchemaWithItsFormerNamesAndValues) {
  const RenderOptions plain = OptionsOf(SchemaOne({}), "a.png");
  RenderOptions untouched;
  options::OptionList list;
  untouched.List(list);
  for (const options::Option& option : list) {
    // These have other defaults since then; --figure was another option.
    if (option.name == "size" || option.name == "out" || option.name == "figure") continue;
    if (option.name == "fit" || option.name == "camera_frame") continue;
    if (SchemaOne({}).at("options").value(option.name, Json("")).is_string()) {
      EXPECT_EQ(OptionText(plain, option.name),
                option.former_name == "frame" ? "100" : option.value->ToText())
          << option.name << " has the default of that version";
    }
  }
  EXPECT_EQ(*plain.view.moves.fit, Fit::kOff);
  EXPECT_EQ(*plain.view.figure, render::Figure::kUrdf) << "there was no skin";
  EXPECT_EQ(*plain.view.moves.camera_frame, CameraFrame::kWorld);
  const RenderOptions options = OptionsOf(SchemaOne({{"overlay", "+scale,+strip,-lamp"},
                                                     {"show", "frames,axes"},
                                                     {"hide", "held"},
                                                     {"figure", "primitive"},
                                                     {"hand", "right:2,left:1.5"},
                                                     {"extra_mass", "head:1.5,t8:8@-0.15,0,0.1"},
                                                     {"robot", ""},
                                                     {"camera", "0,-4,1.2:0,0,1"},
                                                     {"views", "front,right/top,camera"}}),
                                          "a.png");
  EXPECT_EQ(OptionText(options, "frame"), "100");
  EXPECT_EQ(OptionText(options, "body_model"), "primitive");
  EXPECT_EQ(OptionText(options, "hand"), "right:2,left:1.5");
  EXPECT_EQ(options.view.camera->size(), 1u);
  EXPECT_EQ(options.view.views->cameras.size(), 4u);
  const render::OverlayParts& parts = *options.view.overlay;
  EXPECT_TRUE(parts.scale && parts.frame_code && !parts.status && parts.legend);
  const render::SceneLook look = ToPictureSpec(options.view).look;
  EXPECT_TRUE(look.Shows(render::ScenePart::kFrames) && look.Shows(render::ScenePart::kAxes));
  EXPECT_FALSE(look.Shows(render::ScenePart::kHeld));
  EXPECT_THAT(UnknownOptionsOf(SchemaOne({})), ::testing::IsEmpty());
  EXPECT_THAT(UnknownOptionsOf(SchemaOne({{"colour", "red"}})), ::testing::ElementsAre("colour"));
}

TEST(Provenance, ComparesOnlyCommonInputsWithTheFirstSchema) {
  const auto input = [](const char* option, const char* hash) {
    return Json{{"option", option}, {"name", "Head.stl"}, {"sha256", hash}, {"bytes", 5}};
  };
  const auto listing = [](const Json& inputs, int schema) {
    Json json = SchemaOne({}, inputs);
    json["schema"] = schema;
    return json;
  };
  const Json one = Json::array({input("figure", "aa")});
  const std::string present = PresentNameOf("figure", 1);
  const Json same = listing(Json::array({input(present.c_str(), "aa")}), 2);
  const Json other = listing(Json::array({input(present.c_str(), "bb")}), 2);
  const Json none = listing(Json::array(), 2);
  EXPECT_EQ(DifferenceOfInputs(listing(one, 1), same), "") << "a former name is the same option";
  EXPECT_THAT(DifferenceOfInputs(listing(one, 1), other),
              ::testing::AllOf(::testing::HasSubstr("--" + present), ::testing::HasSubstr("bb")));
  EXPECT_EQ(DifferenceOfInputs(listing(one, 1), none), "") << "it may have been listed by mistake";
  EXPECT_EQ(DifferenceOfInputs(listing(Json::array(), 1), same), "") << "or missed";
  Json wild = same, read = same;
  wild["inputs"][0]["name"] = "n\xFF.stl";
  read["inputs"][0]["name"] = "n\uFFFD.stl";
  EXPECT_EQ(DifferenceOfInputs(read, wild), "") << "bytes that JSON cannot have";
  EXPECT_NE(DifferenceOfInputs(same, none), "");
  EXPECT_NE(DifferenceOfInputs(none, same), "");
}

// Of a picture of schema 1, `options` set: without what is named for all pictures before schema 3.
std::vector<std::string> CorrectionsOfSchemaOne(const Json& then) {
  Json two = then;
  two["schema"] = 2;
  two["options"].erase("figure");  // another option since
  std::vector<std::string> clauses = CorrectionsSince(then);
  const std::vector<std::string> of_two = CorrectionsSince(two);
  EXPECT_TRUE(std::equal(of_two.begin(), of_two.end(), clauses.begin())) << "in the order of age";
  clauses.erase(clauses.begin(), clauses.begin() + static_cast<long>(of_two.size()));
  return clauses;
}

TEST(Provenance, NamesTheErrorsOfTheEarlierVersionThatAffectItsPictures) {
  using ::testing::ElementsAre;
  using ::testing::HasSubstr;
  using ::testing::IsEmpty;
  EXPECT_THAT(CorrectionsOfSchemaOne(SchemaOne({})), IsEmpty());
  EXPECT_THAT(CorrectionsOfSchemaOne(SchemaOne({{"plot", "l5_s1"}})), IsEmpty());
  EXPECT_THAT(CorrectionsOfSchemaOne(SchemaOne({{"plot", "l5_s1"}, {"class_limits", "0.1,0.2"}})),
              ElementsAre(HasSubstr("--class_limits")));
  EXPECT_THAT(CorrectionsOfSchemaOne(SchemaOne({{"ghost", "demo:lift@1"}})),
              ElementsAre(HasSubstr("ghost")));
  EXPECT_THAT(CorrectionsOfSchemaOne(SchemaOne({{"ghost", "n_pose"}})), IsEmpty());
  Json clip = SchemaOne({{"size", "320x192"}});
  clip["format"] = "mp4";
  EXPECT_THAT(CorrectionsOfSchemaOne(clip), ElementsAre(HasSubstr("multiple of 128")));
  clip["options"]["size"] = "256x192";
  EXPECT_THAT(CorrectionsOfSchemaOne(clip), IsEmpty());
  Json numbered = SchemaOne({{"plot", "l5_s1"}});
  numbered["number"] = 3;
  EXPECT_THAT(CorrectionsOfSchemaOne(numbered), ElementsAre(HasSubstr("length of the sequence")));
}

TEST(Provenance, NamesWhatPicturesShowedOtherwiseBeforeTheThirdSchema) {
  using ::testing::ElementsAre;
  using ::testing::HasSubstr;
  using ::testing::IsEmpty;
  const auto of = [](const Json& options, int schema = 2) {
    Json then = SchemaOne(options);
    then["schema"] = schema;
    then["options"].erase("figure");  // another option since
    then["source"]["name"] = "take.mvnx";
    return then;
  };
  const auto spheres = HasSubstr("width of the person's limbs"), words = HasSubstr("'no data'");
  EXPECT_THAT(CorrectionsSince(of({})), ElementsAre(spheres, words));
  EXPECT_THAT(CorrectionsSince(of({{"no_overlays", true}})), ElementsAre(spheres));
  EXPECT_THAT(CorrectionsSince(of({{"hide", "loads"}, {"no_overlays", true}})), IsEmpty());
  EXPECT_THAT(CorrectionsSince(of({}, 3)), IsEmpty());
  Json lift = of({{"no_overlays", true}});
  lift["source"]["name"] = "demo:lift";
  EXPECT_THAT(CorrectionsSince(lift), ElementsAre(spheres, HasSubstr("forearms of demo:lift")));
  Json dwelling = of({});
  dwelling["loads"] = {{"low_pass_secs", 0.15}};
  EXPECT_THAT(CorrectionsSince(dwelling), ElementsAre(HasSubstr("--shown"), words));
}

// A folder that is called as a camera, a theme or a segment is no input of the picture.
TEST(Provenance, IgnoresFoldersNamedLikeOptionValues) {
  const testing::TempFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  for (const char* name : {"top", "light", "com", "skeleton"}) {
    std::filesystem::create_directory(name);
    std::ofstream(std::string(name) + "/00.png") << "a picture";
  }
  const Json json = Sample(testing::With<RenderOptions>({{"trail", "com"}}));
  std::filesystem::current_path(before);
  EXPECT_EQ(json.at("inputs").size(), 0u) << json.at("inputs");
}

TEST(Provenance, AcceptsOrRejectsDamagedRecordsWithoutHarm) {
  const std::string whole = ToText(Sample({}));
  std::mt19937 random(3);
  int taken = 0, refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (int k = 0; k < 3; ++k) text[random() % text.size()] = "0\"{}[],:-e9n "[random() % 13];
    const auto json = FromText(text);
    if (!json) continue;
    try {
      EXPECT_EQ(*OptionsOf(*json, "a.mp4").outs, std::vector<std::string>{"a.mp4"});
      ++taken;
    } catch (const std::exception& error) {
      EXPECT_STRNE(error.what(), "");
      ++refused;
    }
  }
  EXPECT_GT(taken, refused) << "most of what still is JSON says nothing that cannot be";
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace kinescope::app
