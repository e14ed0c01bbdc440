#include "app/busy_neighbours.h"

#include "core/errors.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace sandflow {

BusyNeighbours::BusyNeighbours(int count)
{
    const pid_t parent = ::getpid();
    for (int n = 0; n < count; ++n) {
        const pid_t child = ::fork();
        if (child < 0) {
            throw SystemError("a busy process could not be started: too many processes");
        }
        if (child == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (::getppid() != parent) {  // gone before that was set
                ::_exit(0);
            }
            volatile bool forEver = true;
            while (forEver) {
            }
        }
        processes_.push_back(child);
    }
}

BusyNeighbours::~BusyNeighbours()
{
    for (const pid_t process : processes_) {
        ::kill(process, SIGKILL);
        ::waitpid(process, nullptr, 0);
    }
}

}  // namespace sandflow
