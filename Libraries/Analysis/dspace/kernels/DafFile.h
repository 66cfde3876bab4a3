// The container of SPICE's binary kernels: double precision array files.
#ifndef DSPACE_ANALYSIS_DAF_FILE_H
#define DSPACE_ANALYSIS_DAF_FILE_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace dspace {

// Reads a DAF in either byte order, and old files (id word "NAIF/DAF") that do not state theirs.
// Opening reads the file record, the summaries and the names; arrays are read when they are asked
// for, in blocks of 8 KiB, of which 256 MiB are kept. All members may be called by several threads.
//
// Source: NAIF, "DAF Required Reading".
class DafFile {
public:
  struct Array {
    std::string name;            // without trailing blanks
    std::vector<double> doubles; // of the summary
    std::vector<int> integers;   // of the summary, without the two addresses
    std::int64_t first = 0;      // address of the first word; the file's first word is 1
    std::int64_t last = 0;       // of the last
    std::int64_t Count() const { return this->last - this->first + 1; }
  };

  // Notes the file as read (FilesRead.h). Throws Error(Io), or Error(Corrupt) for what is no DAF,
  // for a truncated file, and for addresses outside the file; every address of an array that is
  // opened lies in the file.
  explicit DafFile(const std::string& path);
  ~DafFile();
  DafFile(const DafFile&) = delete;
  DafFile& operator=(const DafFile&) = delete;

  const std::string& Path() const { return this->Path_; }
  std::string Label() const; // "kernel 'NAME'", for errors
  // "SPK", "CK", "PCK"; empty for an old file, which does not state it.
  const std::string& Kind() const { return this->Kind_; }
  bool IsBigEndian() const { return this->BigEndian_; }
  const std::string& InternalName() const { return this->InternalName_; }
  int DoubleCount() const { return this->DoubleCount_; }
  int IntegerCount() const { return this->IntegerCount_; }           // with the two addresses
  const std::vector<Array>& Arrays() const { return this->Arrays_; } // in the order of the file
  // The text in the comment area, which is read now.
  std::string Comments() const;

  // Words `first` to first + count - 1 of an array's addresses. Throws Error(Corrupt) outside the
  // file and Error(Io).
  void Read(std::int64_t first, std::int64_t count, double* words) const;
  std::vector<double> Read(std::int64_t first, std::int64_t count) const;
  double Read(std::int64_t address) const;
  // The same without a copy where the words lie in one block; otherwise they are put into `kept`.
  // Valid as long as the file and `kept`.
  const double* View(std::int64_t first, std::int64_t count, std::vector<double>& kept) const;

  // Bytes read from the file since it was opened, with those read by opening it.
  std::uint64_t BytesRead() const;

private:
  struct Blocks;
  void ReadBytes(std::int64_t offset, void* bytes, std::size_t count) const;
  [[noreturn]] void Damaged(const std::string& what) const;

  std::string Path_;
  std::string Kind_;
  std::string InternalName_;
  bool BigEndian_ = false;
  int DoubleCount_ = 0;
  int IntegerCount_ = 0;
  std::int64_t Size_ = 0; // bytes
  int FirstSummaryRecord_ = 0;
  std::vector<Array> Arrays_;
  std::unique_ptr<Blocks> Blocks_;
};

} // namespace dspace

#endif
