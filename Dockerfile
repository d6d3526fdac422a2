FROM debian:trixie-slim

# Every dependency from Debian: packages/debian.txt is the list, the Makefile's too.
COPY packages/debian.txt packages/select packages/install /opt/evolvent/packages/
RUN /opt/evolvent/packages/install && apt-get clean && rm -rf /var/lib/apt/lists/* && useradd --create-home evolvent

COPY . /opt/evolvent
RUN /opt/evolvent/packages/venv /opt/venv \
 && install -d -m 1777 -o evolvent /out /var/cache/evolvent \
 && ln -s /opt/evolvent/packages/entry /usr/local/bin/evolvent

# Compiled forms and fonts are cached where any user (docker run --user) may write. The rest: one BLAS thread a rank;
# ranks on this machine talk through shared memory only, without the ptrace right that containers lack.
ENV PATH=/usr/local/bin:/opt/venv/bin:/usr/bin:/bin \
    PYTHONDONTWRITEBYTECODE=1 \
    XDG_CACHE_HOME=/var/cache/evolvent \
    MPLCONFIGDIR=/var/cache/evolvent/matplotlib \
    MPLBACKEND=Agg \
    PYVISTA_OFF_SCREEN=true \
    OMP_NUM_THREADS=1 \
    OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    OMPI_MCA_btl=self,vader \
    OMPI_MCA_btl_vader_single_copy_mechanism=none \
    PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe

WORKDIR /opt/evolvent
USER evolvent
ENTRYPOINT ["evolvent"]
CMD ["--help"]
