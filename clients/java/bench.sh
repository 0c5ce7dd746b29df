#!/bin/sh
# Compares the package with bare stubs: ../conformance/example.py ./bench.sh. `mvn package` makes the classes.
built="$(dirname "$(readlink -f "$0")")/target"
exec java -cp "$built/test-classes:$built/classes:$(cat "$built/classpath")" axisgate.Bench
