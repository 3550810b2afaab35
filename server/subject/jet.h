/// A number with its first two derivatives with respect to time (forward-mode automatic
/// differentiation of second order), and vectors and quaternions of such numbers. A pose computed
/// in jets includes its exact velocities and accelerations, so nothing is differentiated
/// numerically. Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace kinescope::subject {

struct Jet {
  double value = 0;
  double rate = 0;   // first derivative, 1/s
  double accel = 0;  // second derivative, 1/s^2

  constexpr Jet() = default;
  constexpr Jet(double constant) : value(constant) {}  // NOLINT: a constant is a jet
  constexpr Jet(double v, double r, double a) : value(v), rate(r), accel(a) {}

  Jet& operator+=(const Jet& b) {
    return *this = {value + b.value, rate + b.rate, accel + b.accel};
  }
  Jet& operator-=(const Jet& b) {
    return *this = {value - b.value, rate - b.rate, accel - b.accel};
  }
  Jet& operator*=(const Jet& b) {
    return *this = {value * b.value, rate * b.value + value * b.rate,
                    accel * b.value + 2 * rate * b.rate + value * b.accel};
  }
  Jet& operator/=(const Jet& b) {
    const double v = value / b.value;  // from value = v * b, differentiated once and twice
    const double r = (rate - v * b.rate) / b.value;
    return *this = {v, r, (accel - 2 * r * b.rate - v * b.accel) / b.value};
  }
};

}  // namespace kinescope::subject

namespace Eigen {

template <>
struct NumTraits<kinescope::subject::Jet> : GenericNumTraits<double> {
  using Real = kinescope::subject::Jet;
  using NonInteger = kinescope::subject::Jet;
  using Nested = kinescope::subject::Jet;
  using Literal = double;
  enum { RequireInitialization = 1, ReadCost = 3, AddCost = 3, MulCost = 9 };
};

}  // namespace Eigen

namespace kinescope::subject {

inline Jet operator-(const Jet& a) { return {-a.value, -a.rate, -a.accel}; }
inline Jet operator+(Jet a, const Jet& b) { return a += b; }
inline Jet operator-(Jet a, const Jet& b) { return a -= b; }
inline Jet operator*(Jet a, const Jet& b) { return a *= b; }
inline Jet operator/(Jet a, const Jet& b) { return a /= b; }

// Compares the values only, which is enough to choose a branch.
inline bool operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
inline bool operator>(const Jet& a, const Jet& b) { return b < a; }
inline bool operator<=(const Jet& a, const Jet& b) { return !(b < a); }
inline bool operator>=(const Jet& a, const Jet& b) { return !(a < b); }

/// f(x), given f and its first two derivatives at x.value.
inline Jet Chain(const Jet& x, double f, double first, double second) {
  return {f, first * x.rate, first * x.accel + second * x.rate * x.rate};
}

inline Jet sin(const Jet& x) {
  const double s = std::sin(x.value);
  return Chain(x, s, std::cos(x.value), -s);
}
inline Jet cos(const Jet& x) {
  const double c = std::cos(x.value);
  return Chain(x, c, -std::sin(x.value), -c);
}
/// @pre x > 0
inline Jet sqrt(const Jet& x) {
  const double s = std::sqrt(x.value);
  return Chain(x, s, 0.5 / s, -0.25 / (s * x.value));
}
/// @pre not both zero
inline Jet atan2(const Jet& y, const Jet& x) {
  const double square = x.value * x.value + y.value * y.value;
  const double turn = x.value * y.rate - y.value * x.rate;
  const double turn_rate = x.value * y.accel - y.value * x.accel;
  const double square_rate = 2 * (x.value * x.rate + y.value * y.rate);
  return {std::atan2(y.value, x.value), turn / square,
          (turn_rate * square - turn * square_rate) / (square * square)};
}
/// @pre -1 < x < 1
inline Jet acos(const Jet& x) { return atan2(sqrt(1.0 - x * x), x); }

using JetVector = Eigen::Matrix<Jet, 3, 1>;
using JetQuaternion = Eigen::Quaternion<Jet>;

/// Right-hand rotations about one axis, rad. Computed from half angles, so the quaternion is
/// continuous over any number of revolutions.
inline JetQuaternion TurnX(const Jet& angle) {
  const Jet half = 0.5 * angle;
  return {cos(half), sin(half), 0.0, 0.0};
}
inline JetQuaternion TurnY(const Jet& angle) {
  const Jet half = 0.5 * angle;
  return {cos(half), 0.0, sin(half), 0.0};
}
inline JetQuaternion TurnZ(const Jet& angle) {
  const Jet half = 0.5 * angle;
  return {cos(half), 0.0, 0.0, sin(half)};
}

inline JetVector Constant(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline JetQuaternion Constant(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace kinescope::subject
