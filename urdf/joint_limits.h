/// Limits of a person's joints for the <limit> elements of the URDF: range, effort and speed. They
/// are wide on purpose: no motion of a living person may exceed them. Every sample of all test
/// recordings is within them (tests/system/mechanism_test.cc). Pure functions, any thread.
///
/// Sources and their grades. A: read in the source itself; B: read in a source that quotes it; C:
/// from memory, not confirmed. Values in degrees; the limits are these values plus a margin.
///
///   neck    flexion 64, extension 63, side 49 (in vivo, mean to 2 SD: anatomystandard.com)       A
///           each of MVN's two joints may take all of it
///   trunk   lumbar flexion 72, extension 29, side 29, turn 7 (Troke et al., Clin. Rehabil. 19,
///           2005: means of the young); lumbar extension 53 to 60 from the vertical in women
///           (Trudelle-Jackson et al., Spine 35, 2010)                                            A
///           the share of each of MVN's four joints                                               C
///   arm     shoulder flexion 180, extension 60, abduction 180, turns 70 and 90; elbow flexion 150,
///           forearm 80 each way; wrist flexion 80, extension 70, radial 20, ulnar 30 (American
///           Academy of Orthopaedic Surgeons, quoted with other measurements in a table of
///           F. A. Davis' goniometry)                                                             B
///   girdle  sternoclavicular elevation 45, depression 5, forward and back 15, with 20 to 30 of
///           the acromioclavicular joint (accessphysiotherapy.mhmedical.com)                      B
///   leg     hip flexion 125, extension 15 to 30, abduction 45, adduction to 45, turns 45; knee 130
///           to 150; foot down 50, up 20, in 35, out 25; toes up 80, down 30 (Merck Manual; hip
///           30 and 120 in OpenSim's gait models, too)                                            B
///   fingers knuckles 90, back 30 to 45, sideways 25; middle joints 100 to 120; ends 80 to 90, back
///           20; thumb 50 to 90 (Merck Manual, and as arm)                                        B
///   speed   upper arm inwards 7500 to 7700 deg/s in pitching (Seroyer et al., Sports Health 2,
///           2010, quoting measurements)                                                          B
///           elbow 2300 deg/s (Fleisig et al., J. Biomech. 32, 1999), knee 1700 deg/s in kicking  C
///   effort  static strength of men, the strongest 5 % or twice the median (joint-loads.md 4.2) B
#pragma once

#include "urdf/segments.h"

namespace kinescope::urdf {

struct AxisLimit {
  double lower = 0, upper = 0;  // rad
  double effort = 0;            // N·m
  double velocity = 0;          // rad/s
};

/// Limits of the rotation about one axis of a body joint; axis 0 1 2 = x y z of its links, chained
/// as in kinematics.h.
AxisLimit LimitOf(int joint, int axis);

enum class FingerJoint { kCarpus, kPalm, kThumbBase, kKnuckle, kMiddle, kEnd };

/// Limits of the rotation about one axis of a joint inside the hand. Fingers bend about x.
AxisLimit LimitOf(FingerJoint joint, bool is_left, int axis);

}  // namespace kinescope::urdf
