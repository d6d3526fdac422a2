FROM debian:trixie-slim

# Every dependency from Debian: packages/debian.txt is the list, the Makefile's too.
COPY packages/debian.txt packages/select packages/install /opt/evolvent/packages/
RUN /opt/evolvent/packages/install && apt-get clean && rm -rf /var/lib/apt/lists/* && useradd --create-home evolvent

COPY . /opt/evolvent
RUN /opt/evolvent/packages/venv /opt/venv \
 && install -d -m 1777 -o evolvent /out \
 && ln -s /opt/evolvent/packages/entry /usr/local/bin/evolvent

# One BLAS thread a rank; ranks on this machine talk through shared memory only, without the ptrace right that containers
# lack, and reach mpirun on loopback. Compiled code is kept in each user's home, or without one (docker run --user) in a folder of that user's in /tmp:
# a folder that several users may write to would let one run code as another.
ENV PATH=/usr/local/bin:/opt/venv/bin:/usr/bin:/bin \
    PYTHONDONTWRITEBYTECODE=1 \
    MPLBACKEND=Agg \
    PYVISTA_OFF_SCREEN=true \
    OMP_NUM_THREADS=1 \
    OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    OMPI_MCA_btl=self,vader \
    OMPI_MCA_btl_vader_single_copy_mechanism=none \
    PMIX_MCA_ptl_tcp_if_include=lo \
    PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe

WORKDIR /opt/evolvent
USER evolvent
ENTRYPOINT ["evolvent"]
CMD ["--help"]
