/* Preloaded: a monotonic clock that runs CLOCK_FACTOR times as fast, and sleeps until its times. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <time.h>

#define SECOND 1000000000LL

typedef int (*sleeper)(clockid_t, int, const struct timespec *, struct timespec *);
typedef int (*reader)(clockid_t, struct timespec *);

static reader real_time;
static sleeper real_sleep;
static long long factor, origin;

static long long of(const struct timespec *t) { return t->tv_sec * SECOND + t->tv_nsec; }

static struct timespec to(long long n) {
    struct timespec t = {n / SECOND, n % SECOND};
    return t;
}

__attribute__((constructor)) static void begin(void) {
    struct timespec now;
    const char *text = getenv("CLOCK_FACTOR");
    real_time = (reader)dlsym(RTLD_NEXT, "clock_gettime");
    real_sleep = (sleeper)dlsym(RTLD_NEXT, "clock_nanosleep");
    real_time(CLOCK_MONOTONIC, &now);
    origin = of(&now);
    factor = text ? atoll(text) : 1;
}

int clock_gettime(clockid_t clock, struct timespec *t) {
    if (!real_time) begin();
    int failed = real_time(clock, t);
    if (!failed && clock == CLOCK_MONOTONIC) *t = to(origin + (of(t) - origin) * factor);
    return failed;
}

int clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *left) {
    if (clock != CLOCK_MONOTONIC || !(flags & TIMER_ABSTIME)) return real_sleep(clock, flags, time, left);
    struct timespec until = to(origin + (of(time) - origin) / factor);
    return real_sleep(clock, flags, &until, left);
}
