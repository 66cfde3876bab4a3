#include <dspace/sky/KernelSet.h>

#include <algorithm>
#include <limits>

#include <dspace/Checks.h>
#include <dspace/FilesRead.h>
#include <dspace/ephemeris/BarycenterSource.h>
#include <dspace/ephemeris/ErfaSource.h>
#include <dspace/ephemeris/SpkSource.h>
#include <dspace/kernels/ClockKernel.h>
#include <dspace/kernels/LeapSecondKernel.h>
#include <dspace/kernels/MetaKernel.h>
#include <dspace/kernels/TextKernel.h>

namespace dspace {
namespace {

constexpr int DeepestMetaKernel = 16;

// One for all: opening it reads its table's header, and tables of the day that are asked for.
std::shared_ptr<const De405Source> InstalledDe405() {
  static const std::shared_ptr<const De405Source> source =
      De405Source::IsInstalled() ? std::make_shared<const De405Source>() : nullptr;
  return source;
}

std::shared_ptr<const StateSource> Erfa() {
  static const std::shared_ptr<const StateSource> source = std::make_shared<const ErfaSource>();
  return source;
}

std::shared_ptr<const StateSource> Barycenters() {
  static const std::shared_ptr<const StateSource> source =
      std::make_shared<const BarycenterSource>();
  return source;
}

} // namespace

// One of the members is set.
struct KernelSet::File {
  std::string path;
  std::shared_ptr<const TextKernel> text;
  std::shared_ptr<const SpkSource> states;
  std::shared_ptr<const BinaryPck> orientations;
  std::shared_ptr<const CkFile> attitudes;
  std::shared_ptr<const EarthOrientation> earth;
};

KernelSet::KernelSet() {
  this->Build();
}

void KernelSet::Open(const std::string& path, int depth) {
  if (depth > DeepestMetaKernel) {
    Reject("text kernel '" + path + "'", "meta-kernels load each other, " +
                                             std::to_string(DeepestMetaKernel) +
                                             " deep; accepted: meta-kernels without loops");
  }
  const auto present = std::find_if(this->Files_.begin(), this->Files_.end(),
                                    [&](const auto& file) { return file->path == path; });
  if (present != this->Files_.end()) {
    std::rotate(present, present + 1, this->Files_.end());
    return;
  }
  NoteFileRead(path); // before it is opened
  auto file = std::make_shared<File>();
  file->path = path;
  if (TextKernel::Recognizes(path)) {
    auto text = std::make_shared<const TextKernel>(TextKernel::Read(path));
    if (IsMetaKernel(*text)) {
      for (const std::string& each : KernelsToLoad(*text)) {
        this->Open(each, depth + 1);
      }
    }
    file->text = text;
  } else if (EarthOrientation::Recognizes(path)) {
    file->earth = std::make_shared<const EarthOrientation>(EarthOrientation::Read(path));
  } else {
    auto daf = std::make_shared<const DafFile>(path);
    if (daf->Kind() == "CK") {
      file->attitudes = std::make_shared<const CkFile>(daf);
    } else if (daf->Kind() == "PCK" || (daf->Kind().empty() && daf->IntegerCount() == 5)) {
      file->orientations = std::make_shared<const BinaryPck>(daf);
    } else {
      file->states = std::make_shared<const SpkSource>(std::make_shared<const SpkFile>(daf));
    }
  }
  this->Files_.push_back(std::move(file));
}

void KernelSet::Build() {
  FrameSources sources;
  auto pool = std::make_shared<KernelPool>();
  this->Ephemeris_ = std::make_shared<Ephemeris>();
  for (const std::shared_ptr<const File>& file : this->Files_) {
    if (file->text) {
      pool->Add(*file->text);
    } else if (file->states) {
      this->Ephemeris_->Load(file->states);
    } else if (file->orientations) {
      sources.orientations.push_back(file->orientations);
    } else if (file->earth) {
      sources.earth = file->earth;
    } else {
      sources.attitudes.push_back(file->attitudes);
    }
  }
  if (HasLeapSeconds(*pool)) {
    sources.scales = TimeScalesOf(*pool);
  }
  if (sources.earth) {
    std::vector<TimeScales::Ut1Row> rows;
    for (const EarthOrientation::Row& row : sources.earth->Rows()) {
      rows.push_back({row.mjd, row.ut1MinusUtc});
    }
    sources.scales.SetUt1(std::move(rows));
  }
  if (pool->Has("NAIF_BODY_NAME") || pool->Has("NAIF_BODY_CODE")) {
    const std::vector<std::string>& names = pool->Texts("NAIF_BODY_NAME");
    const std::vector<double>& codes = pool->Numbers("NAIF_BODY_CODE", names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      this->Ephemeris_->Names().Define(names[i], int(codes[i]));
    }
  }
  sources.pool = pool;
  sources.de405 = InstalledDe405();
  if (sources.de405) {
    this->Ephemeris_->Load(sources.de405, Ephemeris::Priority::Last);
  }
  this->Ephemeris_->Load(Erfa(), Ephemeris::Priority::Last);
  this->Ephemeris_->Load(Barycenters(), Ephemeris::Priority::Last);
  this->Ephemeris_->SetTimeScales(sources.scales);
  auto frames = std::make_shared<const Frames>(std::move(sources));
  this->Ephemeris_->SetFrames(frames);
  this->Frames_ = frames;
}

std::shared_ptr<const KernelSet> KernelSet::With(const std::string& path) const {
  auto set = std::make_shared<KernelSet>(*this);
  set->Open(path, 0);
  set->Paths_.erase(std::remove(set->Paths_.begin(), set->Paths_.end(), path), set->Paths_.end());
  set->Paths_.push_back(path);
  set->Build();
  return set;
}

std::shared_ptr<const KernelSet> KernelSet::Without(const std::string& path) const {
  auto set = std::make_shared<KernelSet>();
  bool found = false;
  std::string known;
  for (const std::string& each : this->Paths_) {
    known += (known.empty() ? "'" : ", '") + each + "'";
    if (each == path) {
      found = true;
      continue;
    }
    set->Paths_.push_back(each);
  }
  if (!found) {
    throw Error(Error::Kind::NotFound, "kernel '" + path + "'",
                "it is not loaded; loaded: " + (known.empty() ? "none" : known));
  }
  for (const std::string& each : set->Paths_) {
    set->Open(each, 0);
  }
  set->Build();
  return set;
}

std::vector<KernelSet::Segment> KernelSet::Segments() const {
  std::vector<Segment> out;
  for (const std::shared_ptr<const File>& file : this->Files_) {
    if (file->states) {
      for (const SpkFile::Segment& s : file->states->File().Segments()) {
        out.push_back(
            {file->path, "SPK", s.name, s.target, s.center, s.frame, s.type, s.begin, s.end});
      }
    } else if (file->orientations) {
      for (const BinaryPck::Segment& s : file->orientations->Segments()) {
        out.push_back(
            {file->path, "PCK", s.name, s.frameClass, 0, s.inertial, s.type, s.begin, s.end});
      }
    } else if (file->attitudes) {
      for (const CkFile::Segment& s : file->attitudes->Segments()) {
        const auto tdb = [&](double ticks) {
          try {
            return ClockKernel(this->Pool(), this->Frames_->ClockOf(s.instrument), this->Scales())
                .TdbOf(ticks);
          } catch (const Error&) {
            return std::numeric_limits<double>::quiet_NaN();
          }
        };
        out.push_back(
            {file->path, "CK", s.name, s.instrument, 0, s.frame, s.type, tdb(s.begin), tdb(s.end)});
      }
    }
  }
  return out;
}

std::vector<KernelContent> KernelSet::Contents() const {
  std::vector<KernelContent> out;
  for (const std::shared_ptr<const File>& file : this->Files_) {
    if (file->text) {
      out.push_back(ContentOf(*file->text, this->Ephemeris_->Names()));
    } else if (file->earth) {
      out.push_back(ContentOf(*file->earth));
    }
  }
  return out;
}

std::vector<std::string> KernelSet::Files() const {
  std::vector<std::string> out;
  for (const std::shared_ptr<const File>& file : this->Files_) {
    out.push_back(file->path);
  }
  return out;
}

} // namespace dspace
