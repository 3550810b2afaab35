/// What reports of urdfdom go to is global to the process: one thread at a time may read a URDF. A
/// module has code of its own, but not an urdfdom of its own.
#pragma once

#include <mutex>

namespace kinescope::urdf {

std::mutex& UrdfdomMutex();

/// For a module: from now on UrdfdomMutex() is that of the program. Before there are threads that
/// read URDFs.
void UseUrdfdomMutexOf(std::mutex& program);

}  // namespace kinescope::urdf
