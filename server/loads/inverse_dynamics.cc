#include "server/loads/inverse_dynamics.h"

namespace kinescope::loads {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using urdf::At;
using urdf::kSegmentCount;

Vector3d AccelerationAt(const SegmentMotion& motion, const Vector3d& arm) {
  return motion.acceleration + motion.angular_acceleration.cross(arm) +
         motion.angular_velocity.cross(motion.angular_velocity.cross(arm));
}

BodyDemand DemandOf(const urdf::LinkPoses& links, const BodyMotion& motion,
                    const urdf::BodyParameters& body, double most_acceleration) {
  BodyDemand demand;
  for (std::size_t i = 0; i < demand.size(); ++i) {
    const Matrix3d world_from_link = links[i].orientation.toRotationMatrix();
    const Vector3d arm = world_from_link * body[i].com_in_link;
    Vector3d acceleration = AccelerationAt(motion[i], arm);
    const double size = acceleration.norm();
    if (size > most_acceleration) acceleration *= most_acceleration / size;
    demand[i].com = links[i].position + arm;
    demand[i].force = body[i].mass * (acceleration + Vector3d(0, 0, kGravity));
    const Vector3d alpha_in_link = world_from_link.transpose() * motion[i].angular_acceleration;
    const Vector3d omega_in_link = world_from_link.transpose() * motion[i].angular_velocity;
    demand[i].spin =
        world_from_link * (body[i].inertia_about_com * alpha_in_link +
                           omega_in_link.cross(body[i].inertia_about_com * omega_in_link));
  }
  return demand;
}

Vector3d CenterOfMassOf(const BodyDemand& demand, const urdf::BodyParameters& body) {
  Vector3d sum = Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < demand.size(); ++i) {
    sum += body[i].mass * demand[i].com;
    mass += body[i].mass;
  }
  return sum / mass;
}

void ExternalForces::Push(const urdf::LinkPoses& links, int segment, const Vector3d& force,
                          const Vector3d& point, const Vector3d& moment) {
  Wrench& wrench = on_[At(segment)];
  wrench.force += force;
  wrench.moment += moment + (point - links[At(segment)].position).cross(force);
}

JointWrenches SolveJoints(const urdf::LinkPoses& links, const BodyDemand& demand,
                          const ExternalForces& external) {
  JointWrenches joints;
  for (int i = 0; i < kSegmentCount; ++i) {
    const SegmentDemand& own = demand[At(i)];
    const Vector3d arm = own.com - links[At(i)].position;
    joints[At(i)].force = own.force - external.on(i).force;
    joints[At(i)].moment = own.spin + arm.cross(own.force) - external.on(i).moment;
  }
  for (int child = kSegmentCount - 1; child > 0; --child) {  // children have higher numbers
    const int parent = urdf::kSegments[At(child)].parent;
    const Vector3d arm = links[At(child)].position - links[At(parent)].position;
    joints[At(parent)].force += joints[At(child)].force;
    joints[At(parent)].moment += joints[At(child)].moment + arm.cross(joints[At(child)].force);
  }
  return joints;
}

Wrench RequiredGroundWrench(const urdf::LinkPoses& links, const BodyDemand& demand,
                            const ExternalForces& external) {
  Wrench ground;
  for (int i = 0; i < kSegmentCount; ++i) {
    const SegmentDemand& own = demand[At(i)];
    const Wrench& pushed = external.on(i);
    ground.force += own.force - pushed.force;
    ground.moment += own.com.cross(own.force) + own.spin - pushed.moment -
                     links[At(i)].position.cross(pushed.force);
  }
  return ground;
}

}  // namespace kinescope::loads
