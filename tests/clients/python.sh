# shellcheck shell=bash
# shellcheck disable=SC2154  # tests/clients.sh, which sources this, sets $built

# With Debian's libraries, the oldest ones that the package supports.
check_python() {
  (cd clients/python && mypy --no-error-summary src)
}
test_python() {
  (cd clients/python/tests && PYTHONPATH=../src /usr/bin/python3 -m unittest discover --pattern '*_test.py')
}

# Makes the wheel, and installs it into an empty environment, with the newest libraries.
install_python() {
  rm -rf "$built/python" && mkdir -p "$built/python" &&
    python3 -m venv "$built/python/venv" &&
    "$built/python/venv/bin/pip" install --quiet --disable-pip-version-check build &&
    "$built/python/venv/bin/python" -m build --outdir "$built/python/dist" clients/python >/dev/null &&
    python3 -m venv --clear "$built/python/venv" &&
    "$built/python/venv/bin/pip" install --quiet --disable-pip-version-check "$built"/python/dist/*.whl &&
    run_example "$built/python/venv/bin/python" clients/python/examples/move_and_wait.py
}

prove_python() {
  local debian=(env PYTHONPATH=clients/python/src /usr/bin/python3)
  timed "python: mypy" check_python
  timed "python: tests" test_python
  timed "python: scenario" conform_everywhere "${debian[@]}" clients/python/conformance/runner.py
  timed "python: scenario, asyncio" conform "${debian[@]}" clients/python/conformance/aio_runner.py
  timed "python: wheel, sdist, example" install_python
  timed "python: scenario, newest libraries" conform "$built/python/venv/bin/python" clients/python/conformance/runner.py
}
