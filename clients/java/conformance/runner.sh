#!/bin/sh
# Translates the acts of the conformance scenario into calls of this package. `mvn package` makes the classes.
built="$(dirname "$(readlink -f "$0")")/../target"
exec java -cp "$built/test-classes:$built/classes:$(cat "$built/classpath")" axisgate.conformance.Runner
