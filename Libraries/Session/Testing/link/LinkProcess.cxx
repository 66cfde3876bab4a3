// Processes for TestLinkKills. It has everything loaded and has no thread yet; for each line that
// it reads it forks a child, which is ready in a few milliseconds:
//   serve ADDRESS RECORDING   serves a plain interpreter and records it
//   drive ADDRESS             drives it, a step further each time
//   watch ADDRESS             follows it
// and says "PID" once that child is ready. It ends with its input, and its children with it.
#include "LinkTestSupport.h"

#include <csignal>
#include <cstdio>
#include <iostream>
#include <sstream>

#include <sys/prctl.h>

#include <dspace/recording/RecordingWriter.h>

namespace {

using namespace dspace;
using namespace dspace::testing;

int Ready(int told) {
  const char word = 'r';
  return write(told, &word, 1) == 1 ? 0 : 1;
}

int Serve(const std::string& address, const std::string& recording, int told) {
  session::ServerOptions options;
  options.listen = address;
  ServedInterpreter served;
  session::RecordingOptions record;
  record.commitEvery_s = 0.005;
  session::RecordingWriter writer(recording, served.ledger, 0, record);
  served.interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
    writer.Add(command, reply, served.ledger);
  });
  session::Server server(options);
  served.server = &server;
  if (Ready(told) != 0) {
    return 1;
  }
  while (server.Run(served.Work(), 10)) {
  }
  return 0;
}

int Drive(const std::string& address, int told) {
  session::RemoteClientOptions options;
  options.address = address;
  options.name = "driver";
  options.takeOver = true;
  session::RemoteClient client(options);
  client.Execute(MakeScene()); // there already, but for the first
  client.Execute(MakeFrame(2));
  client.Execute(MakeFrame(3));
  const v1::Reply last = client.Execute(AskPoses({2}));
  double value = last.poses().pose_size() == 8 ? last.poses().pose(0) : 0;
  if (Ready(told) != 0) {
    return 1;
  }
  while (true) { // both frames always at the same place, a step further each time
    value += 1;
    const v1::Reply reply = int(value) % 16 == 0 ? client.Execute(MakeStep({2, 3}, value))
                                                 : client.Send(MakeStep({2, 3}, value));
    if (reply.has_error()) {
      return 3;
    }
  }
}

int Watch(const std::string& address, int told) {
  session::WatcherOptions options;
  options.address = address;
  session::Watcher watcher(options);
  v1::WatchReply message;
  if (!watcher.Take(message, 20) || Ready(told) != 0) {
    return 1;
  }
  while (watcher.Take(message, 20)) {
  }
  return 0;
}

int Run(const std::string& line, int told) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::istringstream words(line);
  std::string what;
  std::string address;
  std::string recording;
  words >> what >> address >> recording;
  try {
    return what == "serve"   ? Serve(address, recording, told)
           : what == "drive" ? Drive(address, told)
           : what == "watch" ? Watch(address, told)
                             : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", what.c_str(), error.what());
    return 1;
  }
}

} // namespace

int main() {
  std::signal(SIGCHLD, SIG_IGN); // whoever is killed leaves nothing behind
  std::signal(SIGPIPE, SIG_IGN);
  std::string line;
  while (std::getline(std::cin, line)) {
    int ends[2];
    if (pipe(ends) != 0) {
      return 1;
    }
    const pid_t child = fork();
    if (child == 0) {
      close(ends[0]);
      close(0);
      _exit(Run(line, ends[1]));
    }
    close(ends[1]);
    char word = 0;
    const bool ready = child > 0 && read(ends[0], &word, 1) == 1;
    close(ends[0]);
    std::printf("%d\n", ready ? int(child) : 0);
    std::fflush(stdout);
  }
  return 0;
}
