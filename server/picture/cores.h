/// How the cores of this machine are shared among renderers. Pure functions, any thread.
#pragma once

namespace kinescope::app {

/// The number of cores of this machine.
int CoresHere();

/// For render::UseFillingThreads(), where `jobs` pictures are drawn at a time.
int FillingThreads(int cores, int jobs);

}  // namespace kinescope::app
