#include "vtkDspaceRecordingReader.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "RecordingReplies.h"
#include <dspace/messages/WireText.h>
#include <dspace/recording/PlaybackSteps.h>
#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingReader.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceRecordingReader);

namespace {

using dspace::session::RecordingAnswer;
using dspace::session::RecordingRow;
using dspace::v1::RecordingReply;

// Of one answer: what it holds, and what is read for it.
constexpr std::size_t BytesTaken = 1u << 20;
constexpr std::size_t BytesRead = 16u << 20;
constexpr std::size_t RowBytes = 64; // a row besides its payload

std::vector<int> Numbers(const std::string& text) {
  std::vector<int> numbers;
  const char* at = text.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    numbers.push_back(int(std::strtol(at, &end, 10)));
    at = end == at ? end + 1 : end + (*end == ',');
  }
  return numbers;
}

void Put(RecordingRow&& from, dspace::v1::RecordedRow* to) {
  to->set_seq(from.seq);
  to->set_time_s(from.time_s);
  to->set_wall_s(from.wall_s);
  to->set_kind(from.kind);
  const auto& type = *dspace::v1::Command::descriptor();
  std::optional<std::string> readable = from.snapshot
                                            ? dspace::session::WithTextUtf8OfAll(from.payload, type)
                                            : dspace::session::WithTextUtf8(from.payload, type);
  to->set_foreign_text(readable.has_value());
  to->set_payload(readable ? std::move(*readable) : std::move(from.payload));
}

void PutSteps(RecordingReply& reply, const std::vector<std::pair<std::uint64_t, double>>& steps) {
  for (const auto& [seq, time_s] : steps) {
    reply.add_seq(seq);
    reply.add_time_s(time_s);
  }
}

// A part of the rows that `read` goes through. An error after the first row is left to the answer
// that begins there, so that every sound row before it comes.
template<class Read> void PutRows(RecordingReply& reply, const std::vector<int>& kinds, Read read) {
  std::size_t taken = 0, seen = 0;
  std::uint64_t following = 0;
  bool more = false;
  try {
    read([&](RecordingRow&& row) {
      following = row.seq + 1;
      seen += RowBytes + row.payload.size();
      if (kinds.empty() || std::find(kinds.begin(), kinds.end(), row.kind) != kinds.end()) {
        taken += RowBytes + row.payload.size();
        Put(std::move(row), reply.add_row());
      }
      more = taken >= BytesTaken || seen >= BytesRead;
      return !more;
    });
  } catch (const dspace::Error&) {
    if (following == 0) {
      throw;
    }
    more = true;
  }
  reply.set_next(more ? following : 0);
}

} // namespace

struct vtkDspaceRecordingReader::Internals {
  std::optional<dspace::session::RecordingReader> reader;

  // `work` is given the reader and the reply.
  template<class Work> std::string Ask(Work work) {
    return RecordingAnswer([&](RecordingReply& reply) {
      if (!this->reader) {
        throw dspace::Error(dspace::Error::Kind::Internal, "recording", "it is not open");
      }
      work(*this->reader, reply);
    });
  }
};

vtkDspaceRecordingReader::vtkDspaceRecordingReader() : Impl(std::make_unique<Internals>()) {}

vtkDspaceRecordingReader::~vtkDspaceRecordingReader() = default;

std::string vtkDspaceRecordingReader::Open(const std::string& path) {
  this->Close();
  return RecordingAnswer([&](RecordingReply&) { this->Impl->reader.emplace(path); });
}

void vtkDspaceRecordingReader::Close() {
  this->Impl->reader.reset();
}

void vtkDspaceRecordingReader::SetTimeout(double seconds) {
  if (this->Impl->reader) {
    this->Impl->reader->SetTimeout(seconds);
  }
}

std::string vtkDspaceRecordingReader::First() {
  return this->Impl->Ask(
      [](auto& reader, RecordingReply& reply) { reply.set_number(reader.First()); });
}

std::string vtkDspaceRecordingReader::Last() {
  return this->Impl->Ask(
      [](auto& reader, RecordingReply& reply) { reply.set_number(reader.Last()); });
}

std::string vtkDspaceRecordingReader::Begin() {
  return this->Impl->Ask(
      [](auto& reader, RecordingReply& reply) { reply.set_number(reader.Begin()); });
}

std::string vtkDspaceRecordingReader::ReadRows(unsigned long long first, unsigned long long last,
                                               const std::string& kinds) {
  return this->Impl->Ask([&](auto& reader, RecordingReply& reply) {
    PutRows(reply, Numbers(kinds), [&](const auto& take) { reader.ReadRows(first, last, take); });
  });
}

std::string vtkDspaceRecordingReader::ReadOnly(unsigned long long first, unsigned long long last,
                                               const std::string& kinds) {
  return this->Impl->Ask([&](auto& reader, RecordingReply& reply) {
    PutRows(reply, {},
            [&](const auto& take) { reader.ReadOnly(Numbers(kinds), first, last, take); });
  });
}

std::string vtkDspaceRecordingReader::ReadSnapshot(unsigned long long seq) {
  return this->Impl->Ask(
      [&](auto& reader, RecordingReply& reply) { Put(reader.SnapshotRow(seq), reply.add_row()); });
}

std::string vtkDspaceRecordingReader::Snapshots() {
  return this->Impl->Ask([](auto& reader, RecordingReply& reply) {
    for (const std::uint64_t seq : reader.Snapshots()) {
      reply.add_seq(seq);
    }
  });
}

std::string vtkDspaceRecordingReader::Steps(bool oneScene, const std::string& scene) {
  return this->Impl->Ask([&](auto& reader, RecordingReply& reply) {
    PutSteps(reply, reader.Steps(oneScene ? std::optional<std::string>(scene) : std::nullopt));
  });
}

std::string vtkDspaceRecordingReader::StepBegins() {
  return this->Impl->Ask([](auto& reader, RecordingReply& reply) {
    PutSteps(reply, dspace::session::StepBegins(reader));
  });
}

std::string vtkDspaceRecordingReader::PlaybackSteps(bool oneScene, const std::string& scene) {
  return this->Impl->Ask([&](auto& reader, RecordingReply& reply) {
    const dspace::session::PlaybackSteps found = dspace::session::StepsOf(
        reader, oneScene ? std::optional<std::string>(scene) : std::nullopt);
    for (const dspace::session::PlaybackStep& step : found.steps) {
      reply.add_seq(step.end);
      reply.add_time_s(step.time_s);
    }
    for (const dspace::session::PlaybackGap& gap : found.gaps) {
      dspace::v1::RecordedGap* to = reply.add_gap();
      to->set_first(gap.first);
      to->set_last(gap.last);
      if (gap.begin_s) {
        to->set_begin_s(*gap.begin_s);
      }
      if (gap.end_s) {
        to->set_end_s(*gap.end_s);
      }
      to->set_before(gap.before);
    }
  });
}

std::string vtkDspaceRecordingReader::NoSteps() {
  return this->Impl->Ask(
      [](auto& reader, RecordingReply&) { dspace::session::RejectNoSteps(reader); });
}

std::string vtkDspaceRecordingReader::Blocks() {
  return this->Impl->Ask([](auto& reader, RecordingReply& reply) {
    for (const dspace::session::PlaybackBlock& block : dspace::session::BlocksOf(reader)) {
      dspace::v1::RecordedRange* to = reply.add_range();
      to->set_first(block.first);
      to->set_last(block.last);
      if (block.snapshot) {
        to->set_snapshot(*block.snapshot);
      }
    }
  });
}

std::string vtkDspaceRecordingReader::Lost() {
  return this->Impl->Ask([](auto& reader, RecordingReply& reply) {
    for (const auto& [first, last] : reader.Lost()) {
      dspace::v1::RecordedRange* to = reply.add_range();
      to->set_first(first);
      to->set_last(last);
    }
  });
}

std::string vtkDspaceRecordingReader::Summary() {
  return this->Impl->Ask([](auto& reader, RecordingReply& reply) {
    const auto counts = reader.Count();
    dspace::v1::RecordingSummary* to = reply.mutable_summary();
    to->set_snapshots(counts.snapshots);
    to->set_first_time_s(counts.firstTime_s);
    to->set_last_time_s(counts.lastTime_s);
    to->set_first_wall_s(counts.firstWall_s);
    to->set_last_wall_s(counts.lastWall_s);
    for (const auto& kind : counts.kinds) {
      dspace::v1::RecordedKind* each = to->add_kind();
      each->set_kind(kind.kind);
      each->set_count(kind.count);
      each->set_bytes(kind.bytes);
    }
  });
}

std::string vtkDspaceRecordingReader::Assets() {
  return this->Impl->Ask([](auto& reader, RecordingReply& reply) {
    for (const dspace::session::RecordingAsset& asset : reader.Assets()) {
      dspace::v1::RecordedAsset* to = reply.add_asset();
      to->set_id(asset.id);
      to->set_path(asset.path);
      to->set_state(asset.state);
      to->set_size(asset.size);
      to->set_sha256(asset.sha256);
      to->set_packed(asset.packed);
    }
  });
}

void vtkDspaceRecordingReader::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Path: " << (this->Impl->reader ? this->Impl->reader->Path() : "(none)") << "\n";
}
