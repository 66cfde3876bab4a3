#include <dspace/confine/CallFilter.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace dspace::confine {
namespace {

// Numbers of later kernels than the library knows; the same for all processors.
constexpr int Fchmodat2 = 452;
constexpr int Setxattrat = 463;
constexpr int Removexattrat = 466;
constexpr int FileSetattr = 469;

constexpr std::uint64_t Word = 0xFFFFFFFF; // of an argument that the kernel takes as 32 bits

class Filter {
public:
  Filter() : Context_(seccomp_init(SCMP_ACT_ALLOW), seccomp_release) {
    if (!this->Context_) {
      throw std::runtime_error("seccomp: no memory");
    }
  }

  void Reject(int call, std::vector<scmp_arg_cmp> conditions = {}, int error = EPERM) {
    const int result =
        seccomp_rule_add_array(this->Context_.get(), SCMP_ACT_ERRNO(std::uint32_t(error)), call,
                               unsigned(conditions.size()), conditions.data());
    if (result < 0) {
      throw std::runtime_error("seccomp: rule of call " + std::to_string(call) + ": " +
                               std::strerror(-result));
    }
  }

  void Load() { Check(seccomp_load(this->Context_.get())); }

  std::vector<sock_filter> Program() {
    const int file = memfd_create("dspace-calls", MFD_CLOEXEC);
    const int result = file < 0 ? -errno : seccomp_export_bpf(this->Context_.get(), file);
    const off_t size = result < 0 ? 0 : lseek(file, 0, SEEK_END);
    std::vector<sock_filter> program(std::size_t(size) / sizeof(sock_filter));
    const ssize_t got = result < 0 ? 0 : pread(file, program.data(), std::size_t(size), 0);
    if (file >= 0) {
      close(file);
    }
    Check(result < 0 ? result : got != size || size == 0 ? -EIO : 0);
    return program;
  }

private:
  static void Check(int result) {
    if (result < 0) {
      throw std::runtime_error(std::string("seccomp: ") + std::strerror(-result));
    }
  }

  const std::unique_ptr<void, void (*)(scmp_filter_ctx)> Context_;
};

void RejectReachingAround(Filter& filter) {
  for (const int call : {SCMP_SYS(ptrace),
                         SCMP_SYS(process_vm_readv),
                         SCMP_SYS(process_vm_writev),
                         SCMP_SYS(pidfd_getfd),
                         SCMP_SYS(bpf),
                         SCMP_SYS(perf_event_open),
                         SCMP_SYS(userfaultfd),
                         SCMP_SYS(keyctl),
                         SCMP_SYS(add_key),
                         SCMP_SYS(request_key),
                         SCMP_SYS(open_by_handle_at),
                         SCMP_SYS(mount),
                         SCMP_SYS(umount2),
                         SCMP_SYS(move_mount),
                         SCMP_SYS(open_tree),
                         SCMP_SYS(fsopen),
                         SCMP_SYS(fsconfig),
                         SCMP_SYS(fsmount),
                         SCMP_SYS(fspick),
                         SCMP_SYS(mount_setattr),
                         SCMP_SYS(pivot_root),
                         SCMP_SYS(chroot),
                         SCMP_SYS(unshare),
                         SCMP_SYS(setns),
                         SCMP_SYS(shmget),
                         SCMP_SYS(shmat),
                         SCMP_SYS(shmctl),
                         SCMP_SYS(msgget),
                         SCMP_SYS(msgsnd),
                         SCMP_SYS(msgrcv),
                         SCMP_SYS(msgctl),
                         SCMP_SYS(semget),
                         SCMP_SYS(semop),
                         SCMP_SYS(semtimedop),
                         SCMP_SYS(semctl),
                         SCMP_SYS(mq_open),
                         SCMP_SYS(mq_unlink)}) {
    filter.Reject(call);
  }
  for (const int call : {SCMP_SYS(io_uring_setup), SCMP_SYS(io_uring_enter),
                         SCMP_SYS(io_uring_register), SCMP_SYS(clone3)}) {
    filter.Reject(call, {}, ENOSYS); // clone3 has its flags in memory: glibc then calls clone
  }
  filter.Reject(SCMP_SYS(prlimit64), {SCMP_A0(SCMP_CMP_NE, 0, 0)}); // 0: the own limits
  for (const std::uint64_t flag : {CLONE_NEWUSER, CLONE_NEWNS, CLONE_NEWPID, CLONE_NEWNET,
                                   CLONE_NEWIPC, CLONE_NEWUTS, CLONE_NEWCGROUP}) {
    filter.Reject(SCMP_SYS(clone), {SCMP_A0(SCMP_CMP_MASKED_EQ, flag, flag)});
  }
  for (const std::uint64_t request : {std::uint64_t(TIOCSTI), std::uint64_t(TIOCLINUX)}) {
    filter.Reject(SCMP_SYS(ioctl), {SCMP_A1(SCMP_CMP_MASKED_EQ, Word, request)});
  }
}

void RejectAdministration(Filter& filter) {
  for (const int call : {SCMP_SYS(init_module),
                         SCMP_SYS(finit_module),
                         SCMP_SYS(delete_module),
                         SCMP_SYS(kexec_load),
                         SCMP_SYS(kexec_file_load),
                         SCMP_SYS(reboot),
                         SCMP_SYS(swapon),
                         SCMP_SYS(swapoff),
                         SCMP_SYS(acct),
                         SCMP_SYS(quotactl),
                         SCMP_SYS(settimeofday),
                         SCMP_SYS(clock_settime),
                         SCMP_SYS(adjtimex),
                         SCMP_SYS(clock_adjtime),
                         SCMP_SYS(sethostname),
                         SCMP_SYS(setdomainname),
                         SCMP_SYS(iopl),
                         SCMP_SYS(ioperm),
                         SCMP_SYS(syslog),
                         SCMP_SYS(vhangup)}) {
    filter.Reject(call);
  }
}

void RejectChangesByName(Filter& filter, bool truncate) {
  for (const int call :
       {SCMP_SYS(chmod), SCMP_SYS(fchmodat), Fchmodat2, SCMP_SYS(chown), SCMP_SYS(lchown),
        SCMP_SYS(fchownat), SCMP_SYS(setxattr), SCMP_SYS(lsetxattr), SCMP_SYS(removexattr),
        SCMP_SYS(lremovexattr), Setxattrat, Removexattrat, FileSetattr, SCMP_SYS(utime),
        SCMP_SYS(utimes), SCMP_SYS(futimesat)}) {
    filter.Reject(call);
  }
  filter.Reject(SCMP_SYS(utimensat), {SCMP_A1(SCMP_CMP_NE, 0, 0)}); // 0: of a descriptor
  if (!truncate) {
    filter.Reject(SCMP_SYS(truncate));
  }
}

void RejectSockets(Filter& filter, const CallRules& rules) {
  if (!rules.listen && !rules.listenUnix && !rules.connect) {
    filter.Reject(SCMP_SYS(bind));
    filter.Reject(SCMP_SYS(listen));
  }
  if (!rules.connect) {
    filter.Reject(SCMP_SYS(connect));
    // Messages can name any address, except on sockets of streams and of sequences of packets.
    for (std::uint64_t type = 0; type < 16; ++type) {
      for (const std::uint64_t domain : {AF_UNIX, AF_INET, AF_INET6}) {
        const bool own = type == SOCK_STREAM || (type == SOCK_SEQPACKET && domain == AF_UNIX);
        for (const int call : {SCMP_SYS(socket), SCMP_SYS(socketpair)}) {
          if (!own) {
            filter.Reject(call, {SCMP_A0(SCMP_CMP_MASKED_EQ, Word, domain),
                                 SCMP_A1(SCMP_CMP_MASKED_EQ, 0xF, type)});
          }
        }
      }
    }
    // A TCP stream can connect with its first message.
    const std::uint64_t fast = MSG_FASTOPEN;
    filter.Reject(SCMP_SYS(sendto), {SCMP_A3(SCMP_CMP_MASKED_EQ, fast, fast)});
    filter.Reject(SCMP_SYS(sendmsg), {SCMP_A2(SCMP_CMP_MASKED_EQ, fast, fast)});
    filter.Reject(SCMP_SYS(sendmmsg), {SCMP_A3(SCMP_CMP_MASKED_EQ, fast, fast)});
  }
  // Streams of a Unix socket are everybody's; netlink tells the names and addresses of interfaces.
  const bool network = rules.listen || rules.connect;
  for (std::uint64_t domain = 0; domain < 64; ++domain) {
    const bool own = domain == AF_UNIX ||
                     (network && (domain == AF_INET || domain == AF_INET6 || domain == AF_NETLINK));
    if (!own) {
      filter.Reject(SCMP_SYS(socket), {SCMP_A0(SCMP_CMP_MASKED_EQ, Word, domain)});
    }
  }
}

void RejectAll(Filter& filter, std::initializer_list<int> calls) {
  for (const int call : calls) {
    filter.Reject(call);
  }
}

void RejectWriting(Filter& filter) {
  for (const std::uint64_t flag : {O_WRONLY, O_RDWR, O_CREAT, O_TRUNC}) {
    filter.Reject(SCMP_SYS(open), {SCMP_A1(SCMP_CMP_MASKED_EQ, flag, flag)});
    filter.Reject(SCMP_SYS(openat), {SCMP_A2(SCMP_CMP_MASKED_EQ, flag, flag)});
  }
  filter.Reject(SCMP_SYS(openat2), {}, ENOSYS); // it has its flags in memory
  RejectAll(filter, {SCMP_SYS(creat), SCMP_SYS(unlink), SCMP_SYS(unlinkat), SCMP_SYS(rename),
                     SCMP_SYS(renameat), SCMP_SYS(renameat2), SCMP_SYS(mkdir), SCMP_SYS(mkdirat),
                     SCMP_SYS(rmdir), SCMP_SYS(link), SCMP_SYS(linkat), SCMP_SYS(symlink),
                     SCMP_SYS(symlinkat), SCMP_SYS(mknod), SCMP_SYS(mknodat)});
  // A descriptor for reading is enough for these.
  RejectAll(filter, {SCMP_SYS(fchmod), SCMP_SYS(fchown), SCMP_SYS(fsetxattr),
                     SCMP_SYS(fremovexattr), SCMP_SYS(ioctl)});
  filter.Reject(SCMP_SYS(utimensat), {SCMP_A1(SCMP_CMP_EQ, 0, 0)});
}

void RejectOtherProcesses(Filter& filter) {
  RejectAll(filter,
            {SCMP_SYS(execve), SCMP_SYS(execveat), SCMP_SYS(fork), SCMP_SYS(vfork), SCMP_SYS(kill),
             SCMP_SYS(tkill), SCMP_SYS(rt_sigqueueinfo), SCMP_SYS(rt_tgsigqueueinfo),
             SCMP_SYS(pidfd_open), SCMP_SYS(pidfd_send_signal)});
  filter.Reject(SCMP_SYS(clone), {SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_THREAD, 0)}); // threads may
}

void RejectMoreRights(Filter& filter) {
  filter.Reject(SCMP_SYS(setrlimit));
  filter.Reject(SCMP_SYS(prlimit64), {SCMP_A2(SCMP_CMP_NE, 0, 0)});
  filter.Reject(SCMP_SYS(prctl), {SCMP_A0(SCMP_CMP_MASKED_EQ, Word, PR_SET_PDEATHSIG)});
  RejectAll(filter, {SCMP_SYS(setuid), SCMP_SYS(setgid), SCMP_SYS(setreuid), SCMP_SYS(setregid),
                     SCMP_SYS(setresuid), SCMP_SYS(setresgid), SCMP_SYS(setfsuid),
                     SCMP_SYS(setfsgid), SCMP_SYS(setgroups), SCMP_SYS(capset)});
}

void RejectAllSockets(Filter& filter) {
  RejectAll(filter, {SCMP_SYS(socket), SCMP_SYS(socketpair), SCMP_SYS(connect), SCMP_SYS(bind),
                     SCMP_SYS(listen), SCMP_SYS(accept), SCMP_SYS(accept4), SCMP_SYS(sendmmsg)});
  filter.Reject(SCMP_SYS(sendto), {SCMP_A4(SCMP_CMP_NE, 0, 0)}); // an address
}

} // namespace

std::vector<sock_filter> CallsOfReader() {
  Filter filter;
  RejectReachingAround(filter);
  RejectAdministration(filter);
  RejectChangesByName(filter, false);
  RejectWriting(filter);
  RejectOtherProcesses(filter);
  RejectMoreRights(filter);
  RejectAllSockets(filter);
  return filter.Program();
}

void FilterCallsOfReader(const std::vector<sock_filter>& calls) {
  Filter others; // tgkill is how a process ends itself
  others.Reject(SCMP_SYS(tgkill), {SCMP_A0(SCMP_CMP_NE, static_cast<std::uint64_t>(getpid()), 0)});
  others.Load();
  const sock_fprog program = {static_cast<unsigned short>(calls.size()),
                              const_cast<sock_filter*>(calls.data())};
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) {
    throw std::runtime_error(std::string("seccomp: ") + std::strerror(errno));
  }
}

void FilterCalls(const CallRules& rules) {
  Filter filter;
  RejectReachingAround(filter);
  RejectAdministration(filter);
  RejectChangesByName(filter, rules.truncate);
  RejectSockets(filter, rules);
  filter.Load();
}

} // namespace dspace::confine
