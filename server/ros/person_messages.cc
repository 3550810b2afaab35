#include "server/ros/person_messages.h"

#include <kinescope/SetHandLoad.h>
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace kinescope::ros_bridge {

using kinescope_ros::Person;

void FillPerson(const PersonState& person, const PersonNames& names, const std::string& topics,
                Person& message) {
  const urdf::BodyDescription& body = person.model->description;
  message.pelvis_frame = names.links[urdf::kPelvis];
  message.topics = topics;
  message.body_mass =
      body.mass_is_assumed ? std::numeric_limits<double>::quiet_NaN() : body.mass_kg;
  message.sex = Person::SEX_NOT_TOLD;
  if (!body.sex_is_assumed) {
    message.sex = body.sex == urdf::Sex::kMale ? Person::MALE : Person::FEMALE;
  }
  const HandLoad& held = person.forces.stated_hand_load;
  message.hand_load_known = held.is_known;
  message.hand_load.right_kg = held.mass_kg[urdf::kRight];
  message.hand_load.left_kg = held.mass_kg[urdf::kLeft];
  message.hand_load.both_kg = held.both_kg;
  const auto com = [&](urdf::Side side) {
    const auto& at = held.com_in_hand[side];
    return at ? std::vector<double>(at->data(), at->data() + at->size()) : std::vector<double>();
  };
  message.hand_load.right_com = com(urdf::kRight);
  message.hand_load.left_com = com(urdf::kLeft);
}

bool AreEqual(const Person& a, const Person& b) {
  const ros::SerializedMessage of_a = ros::serialization::serializeMessage(a);
  const ros::SerializedMessage of_b = ros::serialization::serializeMessage(b);
  return of_a.num_bytes == of_b.num_bytes &&
         std::equal(of_a.buf.get(), of_a.buf.get() + of_a.num_bytes, of_b.buf.get());
}

PersonChange ToldOf(const Person& message) {
  PersonChange told;
  if (!std::isnan(message.body_mass)) told.mass_kg = message.body_mass;
  if (message.sex == Person::MALE) told.sex = urdf::Sex::kMale;
  if (message.sex == Person::FEMALE) told.sex = urdf::Sex::kFemale;
  return told;
}

template <class Message>
std::string ReadHandLoad(const Message& message, HandLoad& load) {
  load = HandLoad();
  load.is_known = true;
  load.mass_kg = {message.right_kg, message.left_kg};
  load.both_kg = message.both_kg;
  std::string wrong;
  for (const auto& [side, com] :
       {std::pair(urdf::kRight, &message.right_com), std::pair(urdf::kLeft, &message.left_com)}) {
    if (com->size() == 3) {
      load.com_in_hand[side] = Eigen::Vector3d::Map(com->data());
    } else if (!com->empty()) {
      wrong =
          fmt::format("centre of mass with {} numbers: expected x, y and z, or none", com->size());
    }
  }
  return wrong;
}

template std::string ReadHandLoad(const kinescope_ros::HandLoad&, HandLoad&);
template std::string ReadHandLoad(const kinescope_ros::SetHandLoad::Request&, HandLoad&);

}  // namespace kinescope::ros_bridge
