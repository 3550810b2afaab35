#include "server/http/api.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/palette.h"
#include "core/person_links.h"
#include "core/person_outline.h"
#include "tests/mesh_file_on_demand.h"
#include "tests/server/http/test_scene.h"
#include "tests/worn.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

SceneState Scene(const std::string& mesh_folder = "", int people = 1) {
  return testing::MakeScene(41, 3.25, 5'000'000'000, testing::MakePersonModel(7, mesh_folder),
                            people);
}

// Each file contains its own name.
class FilesOfNames : public MeshFiles {
 public:
  std::shared_ptr<const std::string> Content(const std::string& name) const override {
    return std::make_shared<const std::string>(name);
  }
  bool Provide() const override { return false; }
};

TEST(ModelJson, HasEverySegmentWithTheVisualsOfItsLink) {
  const SceneState state = Scene();
  const json model = json::parse(ModelJson(&state, {}));
  ASSERT_EQ(model["people"].size(), 1u);
  const json& person = model["people"][0];
  EXPECT_EQ(person["revision"], 7);
  EXPECT_EQ(person["height_m"], 1.75);
  EXPECT_EQ(person["mass_is_assumed"], true);
  EXPECT_EQ(person["marks"]["com_ring"], MarkSizesOf(1.75).com_ring);
  ASSERT_EQ(person["marks"]["depths"].size(), static_cast<std::size_t>(urdf::kJointCount));
  EXPECT_EQ(person["marks"]["depths"][urdf::kJointCount - 1],
            SphereDepth(urdf::kJointCount - 1, 1.75));
  ASSERT_EQ(person["links"].size(), static_cast<std::size_t>(urdf::kSegmentCount));
  std::size_t told = 0, known = 0;
  for (const json& link : person["links"]) {
    EXPECT_FALSE(link["visuals"].empty()) << link["name"];
    told += link["visuals"].size();
  }
  for (const urdf::Link& link : state.people[0].model->robot.links) known += link.visuals.size();
  EXPECT_EQ(told, known);
  EXPECT_EQ(person["links"][urdf::kHead]["name"], "skeleton_head");
}

TEST(ModelJson, HasTheOutlineByWhichPicturesFrameAPerson) {
  SceneState state = Scene();
  PersonState& person = state.people[0];
  kinescope::testing::Wear(person, 0.3,
                           kinescope::testing::WornModel(*person.model, "/tmp/some meshes"));
  person.forces.hands = {};
  const json outline = json::parse(ModelJson(&state, {}))["people"][0]["outline"];
  const std::vector<urdf::Pose> links = VisibleLinkPoses(person);
  const std::vector<Ball> balls = BallsOf(person);
  ASSERT_EQ(outline.size(), balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const json& point = outline[i];
    const urdf::Pose& link = links.at(point["link"].get<std::size_t>());
    const Eigen::Vector3d in_link(point["position"][0].get<double>(),
                                  point["position"][1].get<double>(),
                                  point["position"][2].get<double>());
    const Eigen::Vector3d place = link.position + link.orientation * in_link;
    EXPECT_LT((place - balls[i].center).norm(), 1e-5) << point;
    EXPECT_NEAR(point["radius"].get<double>(), balls[i].radius, 1e-5) << point;
  }
}

TEST(ModelJson, HasTheFingersOfAGlovedHandInsteadOfTheHand) {
  SceneState state = Scene();
  PersonState& person = state.people[0];
  auto model = std::make_shared<PersonModel>(
      *kinescope::testing::WornModel(*person.model, "/tmp/some meshes"));
  model->mesh_files = std::make_shared<FilesOfNames>();
  kinescope::testing::Wear(person, 0.3, model);
  const json links = json::parse(ModelJson(&state, {}))["people"][0]["links"];
  ASSERT_EQ(links.size(), 23u + 40 + 2);
  EXPECT_TRUE(links[urdf::kRightHand]["visuals"].empty());
  EXPECT_EQ(links[23]["name"], "skeleton_right_carpus");
  EXPECT_EQ(links[64]["name"], "skeleton_prop3");
  EXPECT_EQ(links[64]["visuals"][0]["kind"], "box");
  // Each mesh under its own address, and behind that the file that the link is named after.
  std::set<std::string> files;
  for (const json& link : links) {
    for (const json& visual : link["visuals"]) {
      if (visual["kind"] != "mesh") continue;
      const std::string url = visual["mesh"];
      const auto n = std::stoul(url.substr(url.rfind('/') + 1));
      const auto file = FindMesh(&state, 0, 7, n);
      ASSERT_TRUE(file) << url;
      EXPECT_EQ("skeleton_" + *file, link["name"].get<std::string>() + ".stl");
      files.insert(*file);
    }
  }
  EXPECT_EQ(files.size(), 23u - 2 + 40);
}

TEST(DetailsJson, NamesTheTrackedObjects) {
  SceneState state = Scene();
  state.objects = {{4, 2, "HTC Vive", {}, 5}, {4, 3, "\xFF", {}, 5}};
  const json objects = json::parse(DetailsJson(&state, "front", true))["details"]["objects"];
  ASSERT_EQ(objects.size(), 2u);
  EXPECT_EQ(objects[0], (json{{"character", 4}, {"number", 2}, {"name", "HTC Vive"}}));
}

TEST(DetailsJson, NamesThoseWhoAreLeftOut) {
  SceneState state = Scene();
  state.left_out = {{7, "Eve", "900 km from the others"}};
  const json details = json::parse(DetailsJson(&state, "front", true))["details"];
  EXPECT_EQ(details["left_out"],
            (json{{{"character", 7}, {"name", "Eve"}, {"reason", "900 km from the others"}}}));
}

TEST(ModelJson, DescribesVisualsAsInTheUrdf) {
  const SceneState state = Scene();
  const urdf::RobotModel& robot = state.people[0].model->robot;
  const json model = json::parse(ModelJson(&state, {}));
  const json& told = model["people"][0]["links"][urdf::kPelvis]["visuals"][0];
  ASSERT_EQ(robot.links[0].name, "skeleton_pelvis");
  const urdf::Visual& visual = robot.links[0].visuals[0];
  EXPECT_EQ(told["kind"], "box");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(told["size"][static_cast<std::size_t>(i)], visual.geometry.size[i]);
    EXPECT_EQ(told["position"][static_cast<std::size_t>(i)],
              visual.link_from_visual.translation()[i]);
  }
  EXPECT_EQ(told["quaternion"].size(), 4u);
}

TEST(ModelJson, ReplacesThePartsOfTheBodyByTheUrlOfItsSkin) {
  auto model = std::make_shared<PersonModel>(*testing::MakePersonModel(9));
  SceneState state = testing::MakeScene(1, 0, 1, model);
  const auto person = [&](bool draws_skins) -> json {
    return json::parse(ModelJson(&state, {draws_skins}))["people"][0];
  };
  const auto visuals = [](const json& of) {
    std::size_t count = 0;
    for (const json& link : of["links"]) count += link["visuals"].size();
    return count;
  };
  EXPECT_TRUE(person(true)["skin"].is_null()) << "it has no built-in surface";
  const std::size_t all = visuals(person(true));
  model->has_built_in_surface = true;
  EXPECT_EQ(person(true)["skin"], "/api/v1/skin/0/9");
  EXPECT_EQ(visuals(person(true)), 0u);
  EXPECT_TRUE(person(false)["skin"].is_null());
  EXPECT_EQ(visuals(person(false)), all);
  kinescope::testing::Wear(state.people[0]);
  EXPECT_GT(visuals(person(true)), 0u) << "props are no part of the body";
  EXPECT_LT(visuals(person(true)), visuals(person(false)));
}

TEST(ModelJson, ContainsThePaletteOfTheOtherSinks) {
  const json palette = json::parse(ModelJson(nullptr, {}))["palette"];
  EXPECT_EQ(palette["cop"], json(kCopColor));
  EXPECT_EQ(palette["com"], json(kComColor));
  EXPECT_EQ(palette["body"], json(kBodyColor));
  EXPECT_EQ(palette["stale_body"], json(kStaleBodyColor));
  EXPECT_EQ(palette["object"], json(kObjectColor));
  EXPECT_EQ(palette["axes"], json(kAxisColors));
  ASSERT_EQ(palette["classes"].size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const auto load_class = static_cast<LoadClass>(i);
    EXPECT_EQ(palette["classes"][static_cast<std::size_t>(i)]["name"], Name(load_class));
    EXPECT_EQ(palette["classes"][static_cast<std::size_t>(i)]["color"], json(ColorOf(load_class)));
    EXPECT_EQ(palette["classes"][static_cast<std::size_t>(i)]["size"], SizeOf(load_class));
    EXPECT_EQ(palette["classes"][static_cast<std::size_t>(i)]["rim"], RimOf(load_class));
  }
  EXPECT_EQ(palette["clay"], json(kClayColor));
}

TEST(Details, HaveTheCamerasAndWhetherTheyStillSend) {
  SceneState state;
  const auto told = [&] {
    return json::parse(DetailsJson(&state, "front", true, {}))["details"]["images"];
  };
  EXPECT_EQ(told(), json::array());
  CameraImage image;
  image.name = "lab/image_raw";
  image.received_nanos = 1'000'000'000;
  state.images = {std::make_shared<const CameraImage>(image)};
  state.made_nanos = 2'400'000'000;
  EXPECT_EQ(told(), json::parse(R"([{"name": "lab/image_raw", "is_old": false, "camera": null}])"));
  state.made_nanos = 2'600'000'000;
  EXPECT_EQ(told()[0]["is_old"], true);
}

TEST(Details, HaveTheCameraWhereTheSceneIsDrawnOverItsImage) {
  CameraImage image;
  image.name = "lab";
  image.camera =
      ImageCamera{{{1, 2, 3}, {0.5, -0.5, 0.5, -0.5}}, 640, 480, {525, 520}, {319.5, 240}, 0.7};
  SceneState state;
  state.images = {std::make_shared<const CameraImage>(image)};
  const json said = json::parse(DetailsJson(&state, "front", true, {}))["details"]["images"];
  EXPECT_EQ(said[0]["camera"],
            json::parse(R"({"width": 640, "height": 480, "focal_px": [525.0, 520.0],
                            "center_px": [319.5, 240.0], "position": [1.0, 2.0, 3.0],
                            "orientation": [-0.5, 0.5, -0.5, 0.5], "scene_opacity": 0.7})"));
}

TEST(Details, HaveTheRevisionOfWhatIsBesideThePeople) {
  SceneState state;
  DetailsExtras extras;
  const auto told = [&] {
    return json::parse(DetailsJson(&state, "front", true, extras))["details"]["surroundings"];
  };
  EXPECT_TRUE(told().is_null());
  extras.surroundings = 3;
  EXPECT_EQ(told(), 3);
}

TEST(ModelJson, HasTheLookThatTheServerWasStartedWith) {
  EXPECT_EQ(
      json::parse(ModelJson(nullptr, {}))["look"],
      (json{
          {"loads", "spheres"}, {"style", "matte"}, {"trails", json::array()}, {"trail_secs", 2}}));
  PageLook look{true, "both", "clay", 0.5};
  look.trails = {{-1, {0.5, 0.25, 0}, "centre of mass"}};
  look.trail_secs = 6;
  EXPECT_EQ(
      json::parse(ModelJson(nullptr, look))["look"],
      (json{{"loads", "both"},
            {"style", "clay"},
            {"trails", {{{"segment", -1}, {"name", "centre of mass"}, {"color", {0.5, 0.25, 0}}}}},
            {"trail_secs", 6}}));
}

TEST(ModelJson, HasTheOpacityOfBodiesAndOfReferencePoses) {
  SceneState state = Scene();
  state.ghosts = {{state.people[0], 0.25, "N-pose"}};
  PageLook look;
  look.body_opacity = 0.5;
  const json people = json::parse(ModelJson(&state, look))["people"];
  ASSERT_EQ(people.size(), 2u);
  EXPECT_EQ(people[0]["opacity"], 0.5);
  EXPECT_TRUE(people[0]["ghost_opacity"].is_null());
  EXPECT_EQ(people[1]["opacity"], 0.25);
}

TEST(ModelJson, NamesAllJoints) {
  const json joints = json::parse(ModelJson(nullptr, {}))["joints"];
  ASSERT_EQ(joints.size(), static_cast<std::size_t>(urdf::kJointCount));
  EXPECT_EQ(joints[urdf::jRightElbow]["label"], "Right elbow");
}

TEST(StateJson, ContainsNullForUnknownValues) {
  const json nothing = json::parse(StateJson(nullptr, 1));
  EXPECT_EQ(nothing["liveness"], "no data");
  EXPECT_TRUE(nothing["age_ms"].is_null());
  const SceneState state = Scene();
  const json told = json::parse(StateJson(&state, 5'002'000'000));
  EXPECT_EQ(told["liveness"], "live");
  EXPECT_EQ(told["age_ms"], 2.0);
  const json& loads = told["people"][0]["loads"];
  EXPECT_EQ(loads[0]["label"], "L5/S1");
  EXPECT_EQ(loads[0]["class"], "high");
  EXPECT_TRUE(loads.back()["ratio"].is_null()) << "NaN is unknown, never a number";
  EXPECT_EQ(loads.back()["reason"], "left foot is not on the floor");
}

TEST(Json, ReplacesInvalidUtf8InNames) {
  SceneState state = Scene();
  state.people[0].name = "\xFF\xFE<b>";
  state.source = "udp://\x80";
  for (const std::string& text :
       {StateJson(&state, 0), ModelJson(&state, {}), DetailsJson(&state, "front", true)}) {
    EXPECT_TRUE(json::accept(text)) << text;
  }
}

TEST(StateJson, NamesTheOriginOfTheCentreOfMass) {
  SceneState state = Scene();
  EXPECT_EQ(json::parse(StateJson(&state, 0))["people"][0]["com_source"], "mvn");
  state.people[0].com_is_ours = true;
  EXPECT_EQ(json::parse(StateJson(&state, 0))["people"][0]["com_source"], "body_model");
}

TEST(DetailsJson, IsEqualForEqualStates) {
  const SceneState a = Scene();
  SceneState b = a;
  b.number = 99;
  b.people[0].com = Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(DetailsJson(&a, "front", true), DetailsJson(&b, "front", true));
  b.people[0].loads[0].channel = "extension";
  EXPECT_NE(DetailsJson(&a, "front", true), DetailsJson(&b, "front", true));
}

TEST(CamerasJson, ContainsTheParametersOfEveryView) {
  const json told =
      json::parse(CamerasJson(testing::MakeCameras(), {1.5, 0.5, 1.25, 40, 2.5}, "front", false));
  EXPECT_EQ(told["live"], "front");
  EXPECT_EQ(told["has_pictures"], false);
  ASSERT_EQ(told["cameras"].size(), 7u);
  EXPECT_EQ(told["cameras"][0]["name"], "front");
  EXPECT_GT(told["cameras"][0]["position"][0], 4.0) << "front is seen from +x";
  EXPECT_EQ(told["cameras"][0]["turn"], "none");
  EXPECT_EQ(told["framing"], (json{{"min_width_m", 1.5},
                                   {"margin_m", 0.5},
                                   {"narrowest_aspect", 1.25},
                                   {"reach_m", 40},
                                   {"height_m", 2.5}}));
}

// A person with the mesh of the pelvis; the URDF names those of all 23 segments.
SceneState SceneWithPelvis(const std::string& mesh_folder) {
  auto model = std::make_shared<PersonModel>(*testing::MakePersonModel(7, mesh_folder));
  model->mesh_files = std::make_shared<kinescope::testing::MeshFileOnDemand>(
      mesh_folder + "/pelvis.stl", "an STL file");
  SceneState state = Scene();
  state.people[0].model = model;
  return state;
}

TEST(FindMesh, FindsOnlyMeshesOfTheModel) {
  const SceneState state = SceneWithPelvis("/some meshes");
  const auto first = FindMesh(&state, 0, 7, 0);
  ASSERT_TRUE(first);
  EXPECT_EQ(*first, "an STL file");
  EXPECT_FALSE(FindMesh(&state, 0, 7, 1)) << "named, but not of this set";
  EXPECT_FALSE(FindMesh(&state, 0, 7, 23)) << "there are only 23";
  EXPECT_FALSE(FindMesh(&state, 1, 7, 0)) << "no such person";
  EXPECT_FALSE(FindMesh(&state, 0, 6, 0)) << "an old revision";
  EXPECT_FALSE(FindMesh(nullptr, 0, 7, 0));
}

TEST(FindMesh, ReadsNoFiles) {
  for (const char* uri :
       {"package://robot/a.stl", "http://elsewhere/a.stl", "/etc/passwd", "file:///etc/passwd",
        "file:///etc/passwd/", "file:///etc/..", "file://", ""}) {
    SceneState state = SceneWithPelvis("/some meshes");
    auto model = std::make_shared<PersonModel>(*state.people[0].model);
    model->robot.links[0].visuals[0].geometry.mesh_uri = uri;
    state.people[0].model = model;
    EXPECT_FALSE(FindMesh(&state, 0, 7, 0)) << uri;
  }
}

}  // namespace
}  // namespace kinescope::http
