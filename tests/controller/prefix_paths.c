/* Preloaded into LinuxCNC's programs where they are not installed: the two places that they know by name, /usr/bin/rtapi_app and
 * /usr/lib/linuxcnc/modules, are looked for in $LINUXCNC_PREFIX/bin and $LINUXCNC_PREFIX/modules instead. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *moved(const char *path, char *room, size_t size) {
  static const char modules[] = "/usr/lib/linuxcnc/modules/", program[] = "/usr/bin/rtapi_app";
  const char *prefix = getenv("LINUXCNC_PREFIX");
  if (!path || !prefix) return path;
  if (strncmp(path, modules, sizeof modules - 1) == 0)
    snprintf(room, size, "%s/modules/%s", prefix, path + sizeof modules - 1);
  else if (strcmp(path, program) == 0)
    snprintf(room, size, "%s/bin/rtapi_app", prefix);
  else
    return path;
  return room;
}

#define NEXT(type, name) ((type)dlsym(RTLD_NEXT, name))

void *dlopen(const char *path, int flags) {
  char room[4096];
  return NEXT(void *(*)(const char *, int), "dlopen")(moved(path, room, sizeof room), flags);
}
int access(const char *path, int mode) {
  char room[4096];
  return NEXT(int (*)(const char *, int), "access")(moved(path, room, sizeof room), mode);
}
int execvp(const char *path, char *const argv[]) {
  char room[4096];
  return NEXT(int (*)(const char *, char *const[]), "execvp")(moved(path, room, sizeof room), argv);
}
int execv(const char *path, char *const argv[]) {
  char room[4096];
  return NEXT(int (*)(const char *, char *const[]), "execv")(moved(path, room, sizeof room), argv);
}
FILE *fopen(const char *path, const char *mode) {
  char room[4096];
  return NEXT(FILE *(*)(const char *, const char *), "fopen")(moved(path, room, sizeof room), mode);
}
