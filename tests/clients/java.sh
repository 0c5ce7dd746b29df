# shellcheck shell=bash
# shellcheck disable=SC2154  # tests/clients.sh, which sources this, sets $built

test_java() {
  (cd clients/java && mvn --quiet --batch-mode spotless:check verify)
}

# Puts the package into a local repository, and builds the examples with it.
install_java() {
  local folder="$built/java"
  rm -rf "$folder" && mkdir -p "$folder" && cp -r clients/java/examples "$folder/user" &&
    (cd clients/java && mvn --quiet --batch-mode org.apache.maven.plugins:maven-install-plugin:3.1.4:install-file \
      -Dfile=target/axisgate-0.1.0.jar -DpomFile=pom.xml) &&
    (cd "$folder/user" && mvn --quiet --batch-mode compile) &&
    run_example java -cp "$folder/user/target/classes:$(<"$folder/user/target/classpath")" Move
}

prove_java() {
  timed "java: format, tests, reference" test_java
  timed "java: scenario" conform_everywhere clients/java/conformance/runner.sh
  timed "java: installation, example" install_java
}
