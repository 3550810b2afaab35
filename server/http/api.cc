#include "server/http/api.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/compression_limits.h"
#include "core/hand_load_shape.h"
#include "core/palette.h"
#include "core/person_links.h"
#include "core/person_outline.h"
#include "core/system/json_text.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

std::string Text(const json& document) { return JsonText(document); }

json ToJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json ToJson(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

json ToJson(const Rgb& color) { return json(color); }

json OptionalPoint(const std::optional<Eigen::Vector3d>& point) {
  return point ? ToJson(*point) : json(nullptr);
}

std::string_view JointLabel(int joint) {
  return urdf::kJoints[static_cast<std::size_t>(joint)].label;
}

json VectorOrNull(const Eigen::Vector3d& v) { return v.allFinite() ? ToJson(v) : json(nullptr); }

// Time in each class, s, rounded to `step`.
json SecsToJson(const JointLoad& load, double step) {
  json secs = json::object();
  for (std::size_t i = 0; i < load.band_secs.size(); ++i) {
    secs[Name(static_cast<LoadClass>(i))] = std::round(load.band_secs[i] / step) * step;
  }
  return secs;
}

json LoadToJson(const JointLoad& load) {
  return {{"joint", urdf::kJoints[static_cast<std::size_t>(load.joint)].ros_name},
          {"label", JointLabel(load.joint)},
          {"class", Name(load.load_class)},
          {"shown_ratio", NumberOrNull<json>(load.shown_ratio)},
          {"ratio", NumberOrNull<json>(load.ratio)},
          {"moment_nm", NumberOrNull<json>(load.deciding_moment)},
          {"capacity_nm", NumberOrNull<json>(load.capacity)},
          {"channel", load.channel},
          {"reason", load.reason},
          {"is_external", load.is_external},
          {"secs_in_band", SecsToJson(load, 0.001)}};
}

json HandLoadToJson(const HandLoad& stated) {
  return {{"is_known", stated.is_known},
          {"right_kg", stated.mass_kg[urdf::kRight]},
          {"left_kg", stated.mass_kg[urdf::kLeft]},
          {"both_kg", stated.both_kg}};
}

json FloorOrNull(const BodyForces& forces) {
  return forces.why_no_floor.empty() ? json(forces.floor_z) : json(nullptr);
}

json ForcesToJson(const BodyForces& forces) {
  json corners = json::array();
  for (std::size_t i = 0; i < forces.support.size; ++i) {
    corners.push_back({forces.support.corners[i].x(), forces.support.corners[i].y()});
  }
  json hands = json::object(), feet = json::object();
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const char* const name = side == urdf::kRight ? "right" : "left";
    const HandForce& hand = forces.hands[side];
    hands[name] = {{"held_kg", hand.mass_kg},
                   {"force_n", VectorOrNull(hand.force)},
                   {"is_measured", hand.is_measured}};
    const FootForce& foot = forces.feet[side];
    feet[name] = {{"touches_floor", foot.touches_floor},
                  {"force_n", VectorOrNull(foot.force)},
                  {"cop", VectorOrNull(foot.cop)}};
  }
  return {{"metric", Name(forces.metric)},
          {"why_other_metric", forces.why_other_metric},
          {"mode", forces.is_dynamic ? "dynamic" : "static"},
          {"why_static", forces.why_static},
          {"filter", FilterName(forces)},
          {"delay_secs", forces.delay_secs},
          {"floor_z_m", FloorOrNull(forces)},
          {"body_mass_kg", forces.body_mass_kg},
          {"body_mass_is_assumed", forces.body_mass_is_assumed},
          {"why_no_ground", forces.why_no_ground},
          {"ground_is_measured", forces.ground_is_measured},
          {"external_contact_suspected", forces.external_contact_suspected},
          {"residual_force_share", forces.residual_force_share},
          {"residual_moment_share", forces.residual_moment_share},
          {"support", std::move(corners)},
          {"margin_of_stability_m",
           forces.margin_of_stability ? json(*forces.margin_of_stability) : json(nullptr)},
          {"l5_s1_compression_n", forces.lumbar ? json(forces.lumbar->compression) : json(nullptr)},
          {"l5_s1_shear_n", forces.lumbar ? json(forces.lumbar->shear) : json(nullptr)},
          {"com_minus_mvn_m",
           forces.com_minus_mvn ? json(forces.com_minus_mvn->norm()) : json(nullptr)},
          {"com_disagrees", forces.com_disagrees},
          {"hand_load", HandLoadToJson(forces.stated_hand_load)},
          {"hands", std::move(hands)},
          {"feet", std::move(feet)}};
}

// By joint; rounded to a thousandth of a millimetre.
json DeviationToJson(const PersonState& person) {
  const auto millimetres = [](double metres) { return std::round(metres * 1e6) / 1e3; };
  json joints = json::object();
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const auto child = urdf::At(urdf::ChildOf(joint));
    joints[std::string(urdf::kJoints[urdf::At(joint)].ros_name)] = {
        {"now", millimetres(person.deviation.position[child])},
        {"max", millimetres(person.worst_deviation.position[child])}};
  }
  return joints;
}

json PersonToJson(const PersonState& person) {
  json loads = json::array();
  for (const JointLoad& load : person.loads) loads.push_back(LoadToJson(load));
  return {{"character", person.character},
          {"name", person.name},
          {"revision", person.model->revision},
          {"com", OptionalPoint(person.com)},
          {"com_source", person.com_is_ours ? "body_model" : "mvn"},
          {"cop", OptionalPoint(person.cop)},
          {"loads", std::move(loads)},
          {"deviation_mm", DeviationToJson(person)},
          {"forces", ForcesToJson(person.forces)}};
}

bool IsMesh(const urdf::Visual& visual) {
  return visual.geometry.kind == urdf::Geometry::Kind::kMesh;
}

const char* KindName(urdf::Geometry::Kind kind) {
  switch (kind) {
    case urdf::Geometry::Kind::kBox: return "box";
    case urdf::Geometry::Kind::kCylinder: return "cylinder";
    case urdf::Geometry::Kind::kSphere: return "sphere";
    case urdf::Geometry::Kind::kMesh: break;
  }
  return "mesh";
}

json VisualToJson(const urdf::Visual& visual, const std::string& mesh_url) {
  const Eigen::Quaterniond turn(visual.link_from_visual.linear());
  json entry = {{"kind", KindName(visual.geometry.kind)},
                {"size", ToJson(visual.geometry.size)},
                {"position", ToJson(visual.link_from_visual.translation())},
                {"quaternion", ToJson(turn)},
                {"rgba", nullptr}};
  if (visual.rgba)
    entry["rgba"] = {(*visual.rgba)[0], (*visual.rgba)[1], (*visual.rgba)[2], (*visual.rgba)[3]};
  if (IsMesh(visual)) entry["mesh"] = mesh_url;
  return entry;
}

std::string SkinUrl(const PersonState& person) {
  return "/api/v1/skin/" + std::to_string(person.character) + "/" +
         std::to_string(person.model->revision);
}

// In the order of the streamed poses. Links that only carry a joint axis have no visuals and are
// omitted.
json LinksToJson(const PersonState& person, bool is_skin) {
  const PersonModel& model = *person.model;
  json links = json::array();
  const std::vector<std::string> names = VisibleLinks(model.human);
  for (const std::string& name : names) {
    links.push_back({{"name", name}, {"visuals", json::array()}});
  }
  const std::string mesh_folder = "/api/v1/mesh/" + std::to_string(person.character) + "/" +
                                  std::to_string(model.revision) + "/";
  std::size_t mesh_number = 0;
  for (const urdf::Link& link : model.robot.links) {
    const auto found = std::find(names.begin(), names.end(), link.name);
    for (const urdf::Visual& visual : link.visuals) {
      const std::string url = mesh_folder + std::to_string(mesh_number);
      mesh_number += IsMesh(visual) ? 1 : 0;
      if (found == names.end()) continue;
      const auto place = static_cast<std::size_t>(found - names.begin());
      if (is_skin && IsOfBody(model.human, place, visual)) continue;
      links[place]["visuals"].push_back(VisualToJson(visual, url));
    }
  }
  return links;
}

json OutlineToJson(const PersonModel& model) {
  json outline = json::array();
  for (const OutlinePoint& point : OutlineOf(model)) {
    outline.push_back(
        {{"link", point.link}, {"position", ToJson(point.position)}, {"radius", point.radius}});
  }
  return outline;
}

json MarksToJson(double height) {
  const MarkSizes sizes = MarkSizesOf(height);
  json depths = json::array();
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    depths.push_back(SphereDepth(joint, height));
  }
  return {{"depths", std::move(depths)},
          {"com", sizes.com},
          {"com_depth", sizes.com_depth},
          {"com_ring", sizes.com_ring},
          {"com_line", sizes.com_line},
          {"cop_edge", sizes.cop_edge},
          {"cop", sizes.cop}};
}

json ClassesToJson() {
  json classes = json::array();
  for (const LoadClass load_class : kLoadClasses) {
    classes.push_back({{"name", Name(load_class)},
                       {"color", ToJson(ColorOf(load_class))},
                       {"size", SizeOf(load_class)},
                       {"rim", RimOf(load_class)}});
  }
  return classes;
}

json TrailsToJson(const std::vector<PageTrail>& trails) {
  json list = json::array();
  for (const PageTrail& trail : trails) {
    list.push_back(
        {{"segment", trail.segment}, {"name", trail.name}, {"color", ToJson(trail.color)}});
  }
  return list;
}

const SceneState& OrEmpty(const SceneState* state) {
  static const SceneState kEmpty;
  return state != nullptr ? *state : kEmpty;
}

}  // namespace

namespace {

struct ShownPerson {
  const PersonState& person;
  std::optional<double> ghost_opacity;  // of a reference pose
};

std::vector<ShownPerson> PeopleAndGhosts(const SceneState* state) {
  std::vector<ShownPerson> all;
  if (state == nullptr) return all;
  for (const PersonState& person : state->people) all.push_back({person, std::nullopt});
  for (const Ghost& ghost : state->ghosts) all.push_back({ghost.person, ghost.opacity});
  return all;
}

}  // namespace

std::string StateJson(const SceneState* state, std::int64_t now_nanos) {
  const SceneState nothing;
  if (state == nullptr) state = &nothing;
  json people = json::array();
  for (const PersonState& person : state->people) people.push_back(PersonToJson(person));
  json objects = json::array();
  for (const TrackedObject& object : state->objects) {
    objects.push_back({{"name", object.name},
                       {"character", object.character},
                       {"number", object.number},
                       {"position", ToJson(object.pose.position)},
                       {"quaternion", ToJson(object.pose.orientation)}});
  }
  const bool has_age = state->arrival_nanos != 0;
  const double age_ms = static_cast<double>(now_nanos - state->arrival_nanos) / 1e6;
  return Text({{"liveness", Name(state->liveness)},
               {"state_number", state->number},
               {"counter", state->counter},
               {"stamp_nanos", state->stamp_nanos},
               {"time_code_millis", state->time_code_millis},
               {"rate_hz", NumberOrNull<json>(state->rate_hz)},
               {"age_ms", has_age ? json(age_ms) : json(nullptr)},
               {"source", state->source},
               {"people", std::move(people)},
               {"objects", std::move(objects)}});
}

std::string ModelJson(const SceneState* state, const PageLook& look) {
  json people = json::array();
  for (const auto& [person, ghost_opacity] : PeopleAndGhosts(state)) {
    const urdf::BodyDescription& body = person.model->description;
    const bool is_skin = look.draws_skins && person.model->has_built_in_surface;
    people.push_back({{"character", person.character},
                      {"name", person.name},
                      {"revision", person.model->revision},
                      {"ghost_opacity", ghost_opacity ? json(*ghost_opacity) : json()},
                      {"opacity", ghost_opacity.value_or(look.body_opacity)},
                      {"height_m", person.model->human.skeleton.height},
                      {"marks", MarksToJson(person.model->human.skeleton.height)},
                      {"mass_kg", body.mass_kg},
                      {"mass_is_assumed", body.mass_is_assumed},
                      {"skin", is_skin ? json(SkinUrl(person)) : json(nullptr)},
                      {"links", LinksToJson(person, is_skin)},
                      {"outline", OutlineToJson(*person.model)}});
  }
  json joints = json::array();
  for (const urdf::JointInfo& joint : urdf::kJoints) {
    joints.push_back({{"name", joint.ros_name}, {"label", joint.label}});
  }
  return Text({{"people", std::move(people)},
               {"joints", std::move(joints)},
               {"class_limits", OrEmpty(state).class_limits},
               {"compression_limits_n", kCompressionLimits},
               {"look",
                {{"loads", look.loads},
                 {"style", look.style},
                 {"trails", TrailsToJson(look.trails)},
                 {"trail_secs", look.trail_secs}}},
               {"palette",
                {{"classes", ClassesToJson()},
                 {"object", ToJson(kObjectColor)},
                 {"ghost",
                  {{"on_light", ToJson(kGhostOnLight)},
                   {"on_dark", ToJson(kGhostOnDark)},
                   {"share", kGhostShare}}},
                 {"axes", {ToJson(kAxisColors[0]), ToJson(kAxisColors[1]), ToJson(kAxisColors[2])}},
                 {"cop", ToJson(kCopColor)},
                 {"com", ToJson(kComColor)},
                 {"support", ToJson(kSupportColor)},
                 {"held", ToJson(kHandLoadColor)},
                 {"body", ToJson(kBodyColor)},
                 {"clay", ToJson(kClayColor)},
                 {"stale_body", ToJson(kStaleBodyColor)}}}});
}

std::string CamerasJson(const std::vector<CameraView>& cameras, const CameraFraming& framing,
                        const std::string& live_camera, bool has_pictures) {
  json list = json::array();
  for (const CameraView& camera : cameras) {
    list.push_back({{"name", camera.name},
                    {"position", ToJson(camera.position)},
                    {"target", ToJson(camera.target)},
                    {"up", ToJson(camera.up)},
                    {"vertical_fov_rad", camera.vertical_fov_rad},
                    {"turn", camera.turn}});
  }
  return Text({{"cameras", std::move(list)},
               {"framing",
                {{"min_width_m", framing.min_width_m},
                 {"margin_m", framing.margin_m},
                 {"narrowest_aspect", framing.narrowest_aspect},
                 {"reach_m", framing.reach_m},
                 {"height_m", framing.height_m}}},
               {"live", live_camera},
               {"has_pictures", has_pictures}});
}

namespace {

json RecordingToJson(const Playback& playback) {
  const auto secs_or_null = [](const std::optional<std::int64_t>& nanos) {
    return nanos ? json(1e-9 * static_cast<double>(*nanos)) : json();
  };
  // As in the messages of the WebSocket, to the last bit.
  const auto micros = [](std::int64_t nanos) { return static_cast<double>(nanos) / 1e3; };
  return {{"start_micros", micros(playback.start_nanos)},
          {"length_secs", secs_or_null(playback.length_nanos)},
          {"round_secs", secs_or_null(playback.round_nanos)},
          {"ended_micros", playback.ended_nanos ? json(micros(*playback.ended_nanos)) : json()}};
}

json CameraToJson(const ImageCamera& camera) {
  const urdf::Pose& pose = camera.world_from_optical;
  const Eigen::Vector3d& at = pose.position;
  const Eigen::Vector4d xyzw = pose.orientation.coeffs();
  return {{"width", camera.width},
          {"height", camera.height},
          {"focal_px", camera.focal_px},
          {"center_px", camera.center_px},
          {"position", {at.x(), at.y(), at.z()}},
          {"orientation", {xyzw.x(), xyzw.y(), xyzw.z(), xyzw.w()}},
          {"scene_opacity", camera.scene_opacity}};
}

}  // namespace

std::string DetailsJson(const SceneState* state, const std::string& live_camera, bool has_pictures,
                        const DetailsExtras& extras) {
  json people = json::array();
  for (std::size_t i = 0; state != nullptr && i < state->people.size(); ++i) {
    const PersonState& person = state->people[i];
    json loads = json::array();
    for (const JointLoad& load : person.loads) {
      loads.push_back({{"joint", load.joint},
                       {"channel", load.channel},
                       {"reason", load.reason},
                       {"is_external", load.is_external},
                       {"secs_in_band", SecsToJson(load, 1)}});
    }
    people.push_back({{"character", person.character},
                      {"name", person.name},
                      {"mass_kg", person.model->description.mass_kg},
                      {"mass_is_assumed", person.model->description.mass_is_assumed},
                      {"metric", Name(person.forces.metric)},
                      {"why_other_metric", person.forces.why_other_metric},
                      {"why_static", person.forces.why_static},
                      {"why_no_ground", person.forces.why_no_ground},
                      {"filter", FilterName(person.forces)},
                      {"delay_secs", std::round(1e3 * person.forces.delay_secs) / 1e3},
                      {"floor_z_m", FloorOrNull(person.forces)},
                      {"hand_load", HandLoadToJson(person.forces.stated_hand_load)},
                      {"loads", std::move(loads)}});
  }
  json objects = json::array();
  for (std::size_t i = 0; state != nullptr && i < state->objects.size(); ++i) {
    const TrackedObject& object = state->objects[i];
    objects.push_back(
        {{"character", object.character}, {"number", object.number}, {"name", object.name}});
  }
  json left_out = json::array();
  for (std::size_t i = 0; state != nullptr && i < state->left_out.size(); ++i) {
    const LeftOutPerson& person = state->left_out[i];
    left_out.push_back(
        {{"character", person.character}, {"name", person.name}, {"reason", person.why}});
  }
  json images = json::array();
  for (std::size_t i = 0; state != nullptr && i < state->images.size(); ++i) {
    const CameraImage& image = *state->images[i];
    images.push_back({{"name", image.name},
                      {"is_old", IsOld(image, state->made_nanos)},
                      {"camera", image.camera ? CameraToJson(*image.camera) : json()}});
  }
  return Text({{"details",
                {{"source", state != nullptr ? state->source : std::string()},
                 {"camera", live_camera},
                 {"has_pictures", has_pictures},
                 {"class_limits", OrEmpty(state).class_limits},
                 {"class_falls_below", OrEmpty(state).class_falls_below},
                 {"people", std::move(people)},
                 {"objects", std::move(objects)},
                 {"left_out", std::move(left_out)},
                 {"images", std::move(images)},
                 {"recording", extras.playback ? RecordingToJson(*extras.playback) : json()},
                 {"marks_revision", extras.marks_revision ? json(*extras.marks_revision) : json()},
                 {"surroundings", extras.surroundings ? json(*extras.surroundings) : json()}}}});
}

std::shared_ptr<const PersonModel> FindModelWithSkin(const SceneState* state, int character,
                                                     std::uint64_t revision) {
  for (const auto& [person, ghost_opacity] : PeopleAndGhosts(state)) {
    if (person.character != character || person.model->revision != revision) continue;
    return person.model->has_built_in_surface ? person.model : nullptr;
  }
  return nullptr;
}

std::optional<std::uint64_t> LaterRevision(const SceneState* state, int character,
                                           std::uint64_t revision) {
  for (const auto& [person, ghost_opacity] : PeopleAndGhosts(state)) {
    if (person.character == character && person.model->revision > revision) {
      return person.model->revision;
    }
  }
  return std::nullopt;
}

std::shared_ptr<const std::string> FindMesh(const SceneState* state, int character,
                                            std::uint64_t revision, std::size_t n) {
  for (const auto& [person, ghost_opacity] : PeopleAndGhosts(state)) {
    if (person.character != character || person.model->revision != revision) continue;
    if (!person.model->mesh_files) return nullptr;
    std::size_t number = 0;
    for (const urdf::Link& link : person.model->robot.links) {
      for (const urdf::Visual& visual : link.visuals) {
        if (!IsMesh(visual) || number++ != n) continue;
        const std::string& uri = visual.geometry.mesh_uri;
        return person.model->mesh_files->Content(uri.substr(uri.rfind('/') + 1));
      }
    }
  }
  return nullptr;
}

}  // namespace kinescope::http
