/* Installed setuid root in the image. Docker makes a missing directory of `-v "$PWD/out:/out"` as root, where the
   image's user cannot write: give what root owns below /out, and nothing else, to the user who runs this. */
#define _XOPEN_SOURCE 700
#include <ftw.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static int claim(const char *path, const struct stat *status, int type, struct FTW *place)
{
    (void)type, (void)place;
    if (status->st_uid == 0 && (S_ISDIR(status->st_mode) || (S_ISREG(status->st_mode) && status->st_nlink == 1)))
        (void)!lchown(path, getuid(), getgid());
    return 0;
}

/* With a rootless engine root is the caller on the host, and taking a file from root would take it from the caller. */
static int root_is_root(void)
{
    unsigned inside = 1, outside = 1;
    FILE *map = fopen("/proc/self/uid_map", "r");
    int fields = map ? fscanf(map, "%u %u", &inside, &outside) : 0;
    if (map)
        fclose(map);
    return fields == 2 && inside == 0 && outside == 0;
}

int main(void)
{
    struct stat out;
    if (getuid() != 0 && lstat("/out", &out) == 0 && S_ISDIR(out.st_mode) && out.st_uid == 0 && root_is_root())
        nftw("/out", claim, 16, FTW_PHYS | FTW_MOUNT);
    return 0;
}
