#include <dspace/kernels/TextKernel.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <utility>

#include <dspace/Error.h>
#include <dspace/FileText.h>

namespace dspace {
namespace {

constexpr std::size_t MaxNameLength = 32;

bool IsBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && IsBlank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

std::string Upper(std::string_view text) {
  std::string upper(text);
  for (char& c : upper) {
    c = char(std::toupper(static_cast<unsigned char>(c)));
  }
  return upper;
}

// Days from 2000-01-01 of the proleptic Gregorian calendar (H. Hinnant, "chrono-compatible
// low-level date algorithms").
long DaysFrom2000(long year, int month, int day) {
  year -= month <= 2;
  const long era = (year >= 0 ? year : year - 399) / 400;
  const long yearOfEra = year - era * 400;
  const long dayOfYear = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  const long dayOfEra = yearOfEra * 365 + yearOfEra / 4 - yearOfEra / 100 + dayOfYear;
  return era * 146097 + dayOfEra - 730425;
}

int DaysInMonth(long year, int month) {
  static constexpr int Days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  return Days[month - 1] + (month == 2 && leap ? 1 : 0);
}

// The month that a word names, 1 to 12; 0: none. At least three letters, as in "JAN".
int MonthOf(const std::string& word) {
  static const char* const Names[] = {"JANUARY",   "FEBRUARY", "MARCH",    "APRIL",
                                      "MAY",       "JUNE",     "JULY",     "AUGUST",
                                      "SEPTEMBER", "OCTOBER",  "NOVEMBER", "DECEMBER"};
  for (int i = 0; i < 12; ++i) {
    if (word.size() >= 3 && std::string_view(Names[i]).substr(0, word.size()) == word) {
      return i + 1;
    }
  }
  return 0;
}

// A date after "@": a year, then a month (number or name) and a day, or a day of the year; then
// hours, minutes and seconds where given. Between its parts stand '-', '/', ':' or 'T'.
bool ReadDate(const std::string& text, double& seconds) {
  std::vector<std::string> parts;
  std::string part;
  for (const char c : text + "-") {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.') {
      const bool letter = std::isalpha(static_cast<unsigned char>(c)) != 0;
      if (letter && !part.empty() && std::isdigit(static_cast<unsigned char>(part.back()))) {
        if (std::toupper(static_cast<unsigned char>(c)) != 'T') {
          return false;
        }
        parts.push_back(part); // "2005-01-01T00:00"
        part.clear();
        continue;
      }
      part += char(std::toupper(static_cast<unsigned char>(c)));
    } else if (c == '-' || c == '/' || c == ':') {
      if (part.empty()) {
        return false;
      }
      parts.push_back(part);
      part.clear();
    } else {
      return false;
    }
  }
  const auto whole = [](const std::string& digits, long least, long most, long& value) {
    if (digits.empty() || digits.size() > 5 ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
      return false;
    }
    value = std::strtol(digits.c_str(), nullptr, 10);
    return value >= least && value <= most;
  };
  long year = 0;
  if (parts.size() < 2 || parts.size() > 6 || !whole(parts[0], 1, 99999, year)) {
    return false;
  }
  long month = MonthOf(parts[1]);
  long day = 1;
  std::size_t next = 2;
  if (month == 0 && parts[1].size() == 3 && (parts.size() == 2 || parts.size() >= 3) &&
      text.find('-') != std::string::npos && whole(parts[1], 1, 366, day)) {
    month = 1; // a day of the year, which has three digits
    if (day > (DaysInMonth(year, 2) == 29 ? 366 : 365)) {
      return false;
    }
    --day;
  } else {
    if (month == 0 && !whole(parts[1], 1, 12, month)) {
      return false;
    }
    if (parts.size() > 2) {
      if (!whole(parts[2], 1, DaysInMonth(year, int(month)), day)) {
        return false;
      }
      next = 3;
    }
    --day;
  }
  double clock[3] = {0.0, 0.0, 0.0};
  static constexpr double Most[] = {24.0, 60.0, 61.0};
  for (int i = 0; next < parts.size(); ++next, ++i) {
    const std::string& digits = parts[next];
    if (i == 3 || digits.find_first_not_of("0123456789.") != std::string::npos ||
        (digits.find('.') != std::string::npos && next + 1 != parts.size())) {
      return false;
    }
    char* end = nullptr;
    clock[i] = std::strtod(digits.c_str(), &end);
    if (*end != '\0' || !(clock[i] < Most[i])) {
      return false;
    }
  }
  seconds = double(DaysFrom2000(year, int(month), 1) + day) * 86400.0 - 43200.0 +
            clock[0] * 3600.0 + clock[1] * 60.0 + clock[2];
  return true;
}

bool ReadNumber(std::string text, double& value) {
  bool digit = false;
  for (char& c : text) {
    if (c == 'D' || c == 'd') {
      c = 'E'; // Fortran's double precision
    }
    digit = digit || std::isdigit(static_cast<unsigned char>(c));
    if (!std::isdigit(static_cast<unsigned char>(c)) && c != '.' && c != '+' && c != '-' &&
        c != 'E' && c != 'e') {
      return false; // also hexadecimal, "inf" and "nan", which strtod would take
    }
  }
  if (!digit) {
    return false;
  }
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return *end == '\0' && std::isfinite(value);
}

std::string Shown(std::string_view text) {
  std::string shown(text.substr(0, 40));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 32 || static_cast<unsigned char>(c) > 126) {
      c = '?';
    }
  }
  return text.size() > 40 ? shown + "..." : shown;
}

// Goes through the data lines of a text and collects assignments.
class Reader {
public:
  Reader(std::string_view text, const std::string& name) : Text_(text), Name_(name) {}

  std::vector<KernelAssignment> Run() {
    std::vector<KernelAssignment> out;
    while (this->SkipBlanks()) {
      out.push_back(this->ReadAssignment());
    }
    return out;
  }

  bool SawData() const { return this->SawData_; }

private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(Error::Kind::Corrupt, "text kernel '" + this->Name_ + "'",
                "line " + std::to_string(this->Line_) + ": " + what);
  }

  // Loads the next data line into Rest_; false at the end of the text.
  bool NextLine() {
    while (this->At_ < this->Text_.size()) {
      const std::size_t end = this->Text_.find('\n', this->At_);
      const std::size_t stop = end == std::string_view::npos ? this->Text_.size() : end;
      const std::string_view line = this->Text_.substr(this->At_, stop - this->At_);
      this->At_ = end == std::string_view::npos ? stop : end + 1;
      ++this->Line_;
      const std::string_view trimmed = Trim(line);
      if (trimmed == "\\begindata") {
        this->InData_ = true;
        this->SawData_ = true;
      } else if (trimmed == "\\begintext") {
        this->InData_ = false;
      } else if (this->InData_) {
        for (const char c : line) {
          const auto byte = static_cast<unsigned char>(c);
          if ((byte < 32 || byte > 126) && !IsBlank(c)) {
            this->Fail("a data line has the byte " + std::to_string(byte) +
                       "; accepted: printable ASCII characters, blanks and tabs");
          }
        }
        this->Rest_ = line;
        return true;
      }
    }
    return false;
  }

  // Moves to the next character that is no blank; false at the end of the text.
  bool SkipBlanks() {
    for (;;) {
      while (!this->Rest_.empty() && IsBlank(this->Rest_.front())) {
        this->Rest_.remove_prefix(1);
      }
      if (!this->Rest_.empty()) {
        return true;
      }
      if (!this->NextLine()) {
        return false;
      }
    }
  }

  KernelAssignment ReadAssignment() {
    KernelAssignment out;
    out.line = this->Line_;
    std::size_t n = 0;
    while (n < this->Rest_.size() && !IsBlank(this->Rest_[n]) && this->Rest_[n] != '=' &&
           !(this->Rest_[n] == '+' && n + 1 < this->Rest_.size() && this->Rest_[n + 1] == '=')) {
      if (std::string_view("(),'").find(this->Rest_[n]) != std::string_view::npos) {
        this->Fail("'" + Shown(this->Rest_) +
                   "' is no assignment; accepted: NAME = VALUE or "
                   "NAME += VALUE");
      }
      ++n;
    }
    out.name = std::string(this->Rest_.substr(0, n));
    if (out.name.empty() || n > MaxNameLength) {
      this->Fail("the name '" + Shown(out.name) + "' has " + std::to_string(n) +
                 " characters; accepted: 1 to 32");
    }
    this->Rest_.remove_prefix(n);
    const std::string about = "variable " + out.name;
    if (!this->SkipBlanks()) {
      this->Fail(about + " has no value: the file ends; accepted: = or += and a value");
    }
    if (this->Rest_.front() == '+') {
      out.append = true;
      this->Rest_.remove_prefix(1);
    }
    if (this->Rest_.empty() || this->Rest_.front() != '=') {
      this->Fail(about + " is followed by '" + Shown(this->Rest_) + "'; accepted: = or +=");
    }
    this->Rest_.remove_prefix(1);
    if (!this->SkipBlanks()) {
      this->Fail(about + " has no value: the file ends");
    }
    if (this->Rest_.front() != '(') {
      this->ReadItem(out);
      return out;
    }
    this->Rest_.remove_prefix(1);
    bool separated = true; // a comma may not stand first or twice; real kernels have one last
    for (;;) {
      if (!this->SkipBlanks()) {
        this->Fail(about + ": its list, which begins in line " + std::to_string(out.line) +
                   ", has no ')'");
      }
      const char c = this->Rest_.front();
      if (c == ')') {
        this->Rest_.remove_prefix(1);
        break;
      }
      if (c == ',') {
        if (separated) {
          this->Fail(about + ": a comma without a value before it");
        }
        this->Rest_.remove_prefix(1);
        separated = true;
        continue;
      }
      this->ReadItem(out);
      separated = false;
    }
    if (out.numbers.empty() && out.texts.empty()) {
      this->Fail(about + ": its list is empty; accepted: at least one value");
    }
    return out;
  }

  void ReadItem(KernelAssignment& out) {
    const bool first = out.numbers.empty() && out.texts.empty();
    const bool text = this->Rest_.front() == '\'';
    if (!first && text != out.isText) {
      this->Fail("variable " + out.name + " mixes texts and numbers; accepted: values of one kind");
    }
    out.isText = text;
    if (text) {
      out.texts.push_back(this->ReadText(out.name));
      return;
    }
    std::size_t n = 0;
    while (n < this->Rest_.size() && !IsBlank(this->Rest_[n]) &&
           std::string_view("(),='").find(this->Rest_[n]) == std::string_view::npos) {
      ++n;
    }
    const std::string word(this->Rest_.substr(0, n));
    double value = 0.0;
    const bool good = !word.empty() && (word.front() == '@' ? ReadDate(word.substr(1), value)
                                                            : ReadNumber(word, value));
    if (!good) {
      this->Fail("variable " + out.name + " has the value '" +
                 Shown(word.empty() ? this->Rest_ : std::string_view(word)) +
                 "'; accepted: a finite number, a text in single quotes, or a date after '@'");
    }
    this->Rest_.remove_prefix(n);
    out.numbers.push_back(value);
  }

  std::string ReadText(const std::string& name) {
    std::string out;
    std::size_t i = 1;
    for (;; ++i) {
      if (i >= this->Rest_.size()) {
        this->Fail("variable " + name + ": the text '" + Shown(out) +
                   "' has no closing quote on its line");
      }
      if (this->Rest_[i] == '\'') {
        if (i + 1 < this->Rest_.size() && this->Rest_[i + 1] == '\'') {
          ++i;
        } else {
          break;
        }
      }
      out += this->Rest_[i];
    }
    this->Rest_.remove_prefix(i + 1);
    return out;
  }

  std::string_view Text_;
  const std::string& Name_;
  std::string_view Rest_; // of the present data line
  std::size_t At_ = 0;    // of the next line
  int Line_ = 0;
  bool InData_ = false;
  bool SawData_ = false;
};

std::string KindOf(std::string_view text) {
  const std::string_view line = Trim(text.substr(0, text.find('\n')));
  return line.substr(0, 4) == "KPL/" ? Upper(Trim(line.substr(4))) : std::string();
}

} // namespace

TextKernel TextKernel::Parse(const std::string& text, const std::string& name) {
  TextKernel kernel;
  kernel.Name_ = name;
  kernel.Kind_ = KindOf(text);
  Reader reader(text, name);
  kernel.Assignments_ = reader.Run();
  if (!reader.SawData()) {
    throw Error(Error::Kind::Corrupt, "text kernel '" + name + "'",
                "it has no line \"\\begindata\", hence no data");
  }
  return kernel;
}

TextKernel TextKernel::Read(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) {
    throw Error(Error::Kind::NotFound, "text kernel '" + path + "'", "the file cannot be opened");
  }
  const std::streamoff size = file.tellg();
  if (size < 0 || std::size_t(size) > MaxBytes) {
    throw Error(Error::Kind::Resource, "text kernel '" + path + "'",
                "it has " + std::to_string(size) + " bytes; accepted: up to " +
                    std::to_string(MaxBytes));
  }
  std::string text(std::size_t(size), '\0');
  file.seekg(0);
  if (!file.read(text.data(), size)) {
    throw Error(Error::Kind::Io, "text kernel '" + path + "'", "the file cannot be read");
  }
  return Parse(ToFileText(std::move(text), "text kernel '" + path + "'"), path);
}

bool TextKernel::Recognizes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(1024, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  head.resize(std::size_t(file.gcount()));
  if (head.empty() || head.find('\0') != std::string::npos) {
    return false;
  }
  if (head.compare(0, 4, "KPL/") == 0) {
    return true;
  }
  file.clear();
  file.seekg(0);
  for (std::string line; std::getline(file, line);) {
    if (Trim(line) == "\\begindata") {
      return true;
    }
  }
  return false;
}

} // namespace dspace
