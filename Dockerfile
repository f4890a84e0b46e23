# docker build -t maupertuis . && docker run --rm -v "$PWD:/work" maupertuis check model.lag
FROM debian:bookworm-slim AS build
RUN apt-get update && apt-get install -y --no-install-recommends make
COPY . /maupertuis
WORKDIR /maupertuis
RUN make package

FROM debian:bookworm-slim
COPY --from=build /maupertuis/build/packages/maupertuis_*.deb /maupertuis/build/packages/maupertuis-llvm_*.deb \
     /tmp/packages/
RUN apt-get update && apt-get install -y --no-install-recommends /tmp/packages/*.deb && \
    rm -rf /tmp/packages /var/lib/apt/lists/*
ENV LC_ALL=C.UTF-8
WORKDIR /work
ENTRYPOINT ["maup"]
CMD ["--help"]
