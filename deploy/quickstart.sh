#!/usr/bin/env bash
# From a bare Debian 12 to a moving stage: installs what is missing, builds, starts axisgated with a simulated SHRC-203
# and a simulated mill, and shows both at work. Stays up until Ctrl-C; with --once it leaves after the demonstration,
# non-zero when a step failed.
set -euo pipefail

root="$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")"
bin="$root/build/bin"
# The documentation starts these programs from build/bin/ after this script.
programs=(axisgated axisctl shrc203-sim rml1-sim)
config="$root/deploy/demo/axisgate.toml"
log="$root/build/axisgated.log"
# Of this demonstration alone: made again each time, so that no job of the one before waits in the queue.
state="$root/build/quickstart-state"
grpc_port=50203
metrics_port=9203
ready_limit_s=30
# Time of one processor for a file, or a batch of files, on average.
compile_s=10
end_limit_s=10

once=false
daemon=""

fail() {
  printf 'quickstart: %s\n' "$*" >&2
  exit 1
}

read_arguments() {
  case "${1-}" in
    "") ;;
    --once) once=true ;;
    *) fail "unknown argument '$1'; usage: deploy/quickstart.sh [--once]" ;;
  esac
}

# Prints the objects that the programs are linked of, by the commands that compile them.
objects() {
  ninja -C build -t commands "${programs[@]}" | sed -n 's/.* -o \([^ ]*\.o\) -c .*/\1/p'
}

# Says how long the build will take, by the number of objects that do not exist yet.
announce_build() {
  local files=0 object processors seconds
  while read -r object; do
    [[ -e "build/$object" ]] || files=$((files + 1))
  done < <(objects)
  ((files > 0)) || return 0
  processors="$(nproc)"
  seconds=$((files * compile_s / processors))
  printf 'quickstart: compiling %d files; on %d processors this takes about %d min %d s\n' \
    "$files" "$processors" $((seconds / 60)) $((seconds % 60))
}

build() {
  # From the root, because presets are looked up there.
  cd "$root"
  cmake --preset dev || fail "the step 'configure' failed"
  announce_build
  cmake --build --preset dev --target "${programs[@]}" || fail "the step 'build' failed"
}

# Prints the socket inode of the program that listens on the TCP port $1; the kernel's tables have ports in hexadecimal,
# 0A is LISTEN. awk reads to the end: if it left early, cat would end by SIGPIPE and pipefail would end the script.
listener_inode() {
  local port_hex
  printf -v port_hex '%04X' "$1"
  # There is no tcp6 where IPv6 is switched off.
  { cat /proc/net/tcp /proc/net/tcp6 2>/dev/null || true; } |
    awk -v port=":$port_hex" '$4 == "0A" && substr($2, length($2) - 4) == port && !n++ { print $10 }'
}

# Other users' processes hide their sockets: then the name stays unknown.
holder_of() {
  local descriptor process
  descriptor="$(find /proc/[0-9]*/fd -maxdepth 1 -lname "socket:\[$1\]" -print -quit 2>/dev/null || true)"
  process="${descriptor#/proc/}"
  process="${process%%/*}"
  if [[ -n "$process" ]]; then
    printf '%s (process %s)' "$(cat "/proc/$process/comm")" "$process"
  else
    printf 'another process'
  fi
}

require_free_port() {
  local inode
  inode="$(listener_inode "$1")"
  if [[ -n "$inode" ]]; then
    fail "port $1 ($2) is taken by $(holder_of "$inode"). End it and try again, or start build/bin/axisgated with a" \
      "configuration that names other ports."
  fi
}

show_log_and_fail() {
  printf 'The end of %s:\n' "$log" >&2
  tail -n 20 "$log" >&2
  fail "$@"
}

running() {
  kill -0 "$daemon" 2>/dev/null
}

# Ends the daemon that was started here and no other; what it answers is the answer.
end_daemon() {
  local process="$daemon"
  daemon=""
  kill -TERM "$process" 2>/dev/null || true
  if ! timeout "$end_limit_s" tail --pid="$process" --sleep-interval=0.1 --follow /dev/null; then
    kill -KILL "$process" 2>/dev/null || true
  fi
  wait "$process"
}

leave() {
  local code=$?
  if [[ -n "$daemon" ]]; then
    end_daemon || true
  fi
  exit "$code"
}

start_daemon() {
  require_free_port "$grpc_port" gRPC
  require_free_port "$metrics_port" metrics
  rm -rf "$state"
  STATE_DIRECTORY="$state" "$bin/axisgated" --config "$config" >"$log" 2>&1 &
  daemon=$!
}

# A position is read from the controller, so its answer says that the handshake is over, too.
is_ready() {
  local queue
  "$bin/axisctl" position >/dev/null 2>"$log.ready" && queue="$("$bin/axisctl" mill queue 2>"$log.ready")" &&
    [[ "$queue" == *'line open'* ]]
}

wait_until_ready() {
  local deadline=$((SECONDS + ready_limit_s))
  until is_ready; do
    running || show_log_and_fail "the step 'start axisgated' failed: it ended at once"
    if ((SECONDS >= deadline)); then
      cat "$log.ready" >&2
      show_log_and_fail "the step 'start axisgated' failed: not ready after $ready_limit_s s"
    fi
    sleep 0.1
  done
  rm -f "$log.ready"
}

# The path that the daemon really listens on, from the kernel: the seventh column is the socket, the eighth its path.
unix_socket() {
  awk 'NR == FNR { mine[$1]; next } $7 in mine && $8 != "" { print $8; exit }' \
    <(find "/proc/$daemon/fd" -lname 'socket:*' -printf '%l\n' | tr -dc '0-9\n') /proc/net/unix
}

print_endpoints() {
  cat <<END

axisgated is up; its log is $log
  gRPC          127.0.0.1:$grpc_port
  Unix socket   $(unix_socket)
  metrics       http://127.0.0.1:$metrics_port/metrics

Try next:
  $bin/axisctl watch
  $bin/axisctl move 1=+500um --relative
  $bin/axisctl exec 'Q:'
  $bin/axisctl mill queue
END
}

stay_up() {
  printf '\nCtrl-C ends it.\n'
  trap 'exit 0' INT TERM
  local code=0
  wait "$daemon" || code=$?
  daemon=""
  show_log_and_fail "axisgated ended by itself with exit code $code"
}

main() {
  read_arguments "$@"
  "$root/deploy/install-packages.sh" --to-build || fail "the step 'install packages' failed"
  build
  trap leave EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM
  start_daemon
  wait_until_ready
  "$root/deploy/demo/run.sh" "$bin/axisctl" || fail "the step 'demonstration' failed"
  "$root/deploy/demo/mill.sh" "$bin/axisctl" || fail "the step 'demonstration of the mill' failed"
  print_endpoints
  if $once; then
    end_daemon || show_log_and_fail "the step 'end axisgated' failed: exit code $?"
  else
    stay_up
  fi
}

main "$@"
