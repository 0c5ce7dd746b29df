# axisgated and axisctl on Debian 12. Without arguments the daemon serves its built-in simulated SHRC-203. It listens on
# loopback only, so clients outside share its network:
#   docker build --tag axisgate .
#   docker run --name axisgate --network host axisgate
#   docker exec axisgate axisctl status
# With a stage, its line and a configuration of your own:
#   docker run --network host --device /dev/ttyUSB0 --volume "$PWD/axisgate.toml:/etc/axisgate/axisgate.toml:ro" \
#     axisgate --config /etc/axisgate/axisgate.toml
# The journal, tokens and the names of saved positions are in /var/lib/axisgate. That is a volume, since motions are
# refused where nothing can be recorded. --volume axisgate-state:/var/lib/axisgate keeps it over a new container.
FROM debian:bookworm-slim AS build
WORKDIR /src
COPY deploy/debian-packages.txt deploy/install-packages.sh deploy/
RUN deploy/install-packages.sh --to-build
COPY . .
# Where a compiler cache is mounted, if one is: repeated builds take seconds with it.
ARG CCACHE_DIR
RUN cmake --preset release && cmake --build --preset release --target axisgated axisctl

FROM debian:bookworm-slim
# The owners of the libraries that the two programs are linked with; the rest comes with these. The number of the user
# is fixed, so that a mounted folder or a tmpfs for the socket can be given to it.
RUN apt-get update --quiet \
 && apt-get install --quiet --yes --no-install-recommends \
      libfmt9 libgrpc++1.51 libnghttp2-14 libpng16-16 libprometheus-cpp-core1.0 \
      libprotobuf32 libspdlog1.10 libsqlite3-0 libssl3 libsystemd0 libtomlplusplus3 zlib1g \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --system --uid 203 --no-create-home --groups dialout axisgate \
 && install --directory --owner axisgate --group axisgate /run/axisgate /var/lib/axisgate
COPY --from=build /src/build-release/bin/axisgated /src/build-release/bin/axisctl /usr/local/bin/
COPY --from=build /src/deploy/mills /usr/local/share/axisgate/mills
ARG REVISION
LABEL org.opencontainers.image.title="axisgate" \
      org.opencontainers.image.description="Shares the serial line of a SHRC-203 stage controller over gRPC" \
      org.opencontainers.image.licenses="Apache-2.0" \
      org.opencontainers.image.revision="${REVISION}"
ENV AXISGATE_SOCKET=/run/axisgate/axisgate.sock STATE_DIRECTORY=/var/lib/axisgate
USER axisgate
VOLUME /var/lib/axisgate
EXPOSE 50203 9203
# Whether the daemon answers; not whether the line is up, which no new container would mend.
HEALTHCHECK --interval=30s --timeout=5s --start-period=10s CMD ["axisctl", "devices"]
ENTRYPOINT ["axisgated"]
