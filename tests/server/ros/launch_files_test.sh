#!/bin/sh
# launch_files_test.sh SETUP PYTHON FOLDER: launch_files_test.py in the devel space of SETUP.
set -eu
setup=$1 python=$2 folder=$3
# The setup script of catkin runs `python3` from PATH, which may not have catkin_pkg.
PATH=$(dirname "$python"):$PATH
set +u; . "$setup"; set -u
exec "$python" -B "$(dirname "$0")/launch_files_test.py" "$folder"
