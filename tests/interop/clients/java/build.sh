#!/bin/bash
# build.sh FOLDER: builds the client in FOLDER, and leaves the program FOLDER/client.
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)

# The sum covers everything that the program is made from.
sum=$(cd "$source" && find . ../../../../proto -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum)
if [[ -x $folder/client && -e $folder/sum && $(<"$folder/sum") == "$sum" ]]; then
  exit 0
fi
rm -rf "$folder/client" "$folder/sum" "$folder/target"

# Maven runs too briefly for Java's slower compiler to pay off.
export MAVEN_OPTS="-XX:TieredStopAtLevel=1 -XX:+UseSerialGC"
build() {
  mvn --quiet --batch-mode "$@" -f "$source/pom.xml" -DbuildDirectory="$folder/target" compile
}
# Maven's local repository has every artifact if the same pom.xml was built before.
if ! { cmp -s "$source/pom.xml" "$folder/pom.xml" && build --offline; }; then
  build
fi
cp "$source/pom.xml" "$folder/pom.xml"

cat >"$folder/client" <<'END'
#!/bin/bash
folder=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
exec java -XX:TieredStopAtLevel=1 -XX:+UseSerialGC -cp "$folder/target/classes:$folder/target/lib/*" Client "$@"
END
chmod +x "$folder/client"
echo "$sum" >"$folder/sum"
