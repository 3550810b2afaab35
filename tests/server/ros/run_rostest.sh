#!/bin/sh
# run_rostest.sh SETUP PYTHON ROSTEST FOLDER FILE: runs one *.test in the devel space of SETUP, on a free
# UDP port and with its own master. Logs and results go to FOLDER.
set -eu
setup=$1 python=$2 rostest=$3 folder=$4 file=$5
mkdir -p "$folder"
export ROS_HOME="$folder" ROS_LOG_DIR="$folder/log" ROS_TEST_RESULTS_DIR="$folder/results"
export ROS_IP=127.0.0.1
unset ROS_HOSTNAME ROS_MASTER_URI
# The setup script of catkin runs `python3` from PATH, which may not have catkin_pkg.
PATH=$(dirname "$python"):$PATH
set +u; . "$setup"; set -u
# The port is below the kernel's range of automatic ports, so no other program gets it before the suit opens it.
port=$("$python" -c '
import os, socket
end = int(open("/proc/sys/net/ipv4/ip_local_port_range").read().split()[0])
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
for i in range(10000, end):
    port = 10000 + (i + os.getpid()) % (end - 10000)
    try:
        s.bind(("127.0.0.1", port))
    except OSError:
        continue
    print(port)
    break')
# RViz wants a screen; statuses/rviz reports what it shows.
# Drawn by softpipe: once in some thirty starts, before it has read anything of ours, RViz crashed in the libLLVM of llvmpipe.
case $file in
  *rviz_launch.test) PATH=$(dirname "$file")/statuses:$PATH; export LIBGL_ALWAYS_SOFTWARE=1 GALLIUM_DRIVER=softpipe DRAW_USE_LLVM=0 HOME="$folder"; screen='xvfb-run -a' ;;
  *) screen= ;;
esac
exec $screen "$python" "$rostest" "$file" "udp_port:=$port"
