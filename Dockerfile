# axisgated and axisctl on Debian 12. The daemon listens on loopback only, so clients outside share its network:
#   docker build -t axisgate .
#   docker run --network host --device /dev/ttyUSB0 -v "$PWD/axisgate.toml:/etc/axisgate/axisgate.toml:ro" axisgate
# Without a file of your own it runs deploy/axisgate.toml, an example whose tty you do not have.
FROM debian:bookworm-slim AS build
WORKDIR /src
COPY deploy/debian-packages.txt deploy/install-packages.sh deploy/
RUN deploy/install-packages.sh
COPY . .
RUN cmake --preset release && cmake --build --preset release --target axisgated axisctl

FROM debian:bookworm-slim
# The owners of the libraries that the two programs are linked with; the rest comes with these.
RUN apt-get update --quiet \
 && apt-get install --quiet --yes --no-install-recommends \
      libfmt9 libgrpc++1.51 libprometheus-cpp-core1.0 libprometheus-cpp-pull1.0 libprotobuf32 libspdlog1.10 \
      libtomlplusplus3 \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --system --no-create-home --groups dialout axisgate \
 && install --directory --owner axisgate --group axisgate /run/axisgate
COPY --from=build /src/build/bin/axisgated /src/build/bin/axisctl /usr/local/bin/
COPY deploy/axisgate.toml /etc/axisgate/axisgate.toml
ENV AXISGATE_SOCKET=/run/axisgate/axisgate.sock
USER axisgate
EXPOSE 50203 9203
ENTRYPOINT ["axisgated", "--config", "/etc/axisgate/axisgate.toml"]
