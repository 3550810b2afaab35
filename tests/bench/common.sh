# What the measuring scripts of this folder share; sourced. Afterwards $work is an empty folder, and what is in `children`
# ends with the script.
work=$(mktemp -d)
children=()
trap 'kill "${children[@]}" 2>/dev/null || true; wait 2>/dev/null || true; rm -rf "$work"' EXIT
export ROS_HOME=$work/ros ROS_IP=127.0.0.1
unset ROS_HOSTNAME

port_of() { /usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'; }
cpu_ticks() { awk '{ print $14 + $15 }' "/proc/$1/stat"; }
rss_mb() { awk '/^VmRSS/ { printf "%.0f", $2 / 1024 }' "/proc/$1/status"; }
print_machine() { echo "machine: $(nproc) cores, $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1), load $(cut -d' ' -f1-3 /proc/loadavg)"; }
start_master() {  # at $master_port
  /usr/bin/python3 "$(command -v rosmaster)" --core -p "$master_port" >/dev/null 2>&1 & children+=($!)
  until (: >"/dev/tcp/127.0.0.1/$master_port") 2>/dev/null; do sleep 0.1; done
}
