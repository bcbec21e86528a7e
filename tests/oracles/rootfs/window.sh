# A display of its own with a window manager, and a program on it: window.sh WIDTHxHEIGHT PROGRAM ARGUMENTS...
set -eu
size=$1
shift
mkfifo "$TMPDIR/display"
Xvfb -displayfd 3 -screen 0 "${size}x24" -nolisten tcp 3>"$TMPDIR/display" >"$TMPDIR/xvfb.log" 2>&1 &
read -r number <"$TMPDIR/display"
export DISPLAY=":$number"
openbox >"$TMPDIR/openbox.log" 2>&1 &
exec "$@"
