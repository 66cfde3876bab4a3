// A file of settings: whole or not at all, and whatever happens to it, the program goes on.
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <QCryptographicHash>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QTemporaryDir>

#include <dspace/widgets/settings/SettingsFile.h>

using dspace::widgets::SettingsFile;

namespace {

class SettingsFileTest : public ::testing::Test {
protected:
  QTemporaryDir folder;
  QString path = folder.filePath("deep/settings.json");

  QByteArray Bytes() const {
    QFile file(this->path);
    return file.open(QIODevice::ReadOnly) ? file.readAll() : QByteArray();
  }
  void Write(const QByteArray& bytes) const {
    QFile file(this->path);
    ASSERT_TRUE(file.open(QIODevice::WriteOnly | QIODevice::Truncate));
    file.write(bytes);
  }
};

} // namespace

TEST_F(SettingsFileTest, KeepsValuesAndWhatOtherProgramsWrote) {
  SettingsFile first(this->path);
  EXPECT_TRUE(first.Problem().isEmpty());
  EXPECT_TRUE(first.Get("a").isUndefined());
  ASSERT_TRUE(first.Set("a", 3));
  SettingsFile second(this->path);
  ASSERT_TRUE(second.Set("b", QJsonArray{"x", 1.5}));
  ASSERT_TRUE(first.Set("c", true));
  EXPECT_EQ(first.Get("b").toArray().size(), 2);
  const SettingsFile read(this->path);
  EXPECT_EQ(read.Get("a").toInt(), 3);
  EXPECT_EQ(read.Get("b").toArray().at(1).toDouble(), 1.5);
  EXPECT_TRUE(read.Get("c").toBool());
  ASSERT_TRUE(first.Set("a", QJsonValue::Undefined));
  EXPECT_TRUE(SettingsFile(this->path).Get("a").isUndefined());
  // The digest is that of the values as compact JSON: computed here by another path.
  const QJsonObject all = QJsonDocument::fromJson(this->Bytes()).object();
  const QByteArray text = R"({"b":["x",1.5],"c":true})";
  EXPECT_EQ(all["sha256"].toString().toLatin1(),
            QCryptographicHash::hash(text, QCryptographicHash::Sha256).toHex());
}

TEST_F(SettingsFileTest, EveryCutAndEveryFlippedByteGivesTheDefaultsAndAMessage) {
  SettingsFile file(this->path);
  ASSERT_TRUE(file.Set("theme", "dark"));
  ASSERT_TRUE(file.Set("samples", 4));
  const QByteArray good = this->Bytes();
  ASSERT_GT(good.size(), 60);
  for (qsizetype size = 0; size < good.size() - 1; ++size) { // the last byte is a line end
    this->Write(good.left(size));
    const SettingsFile cut(this->path);
    EXPECT_TRUE(cut.Get("theme").isUndefined()) << size;
    EXPECT_NE(cut.Problem().indexOf("settings.json"), -1) << size;
  }
  int wrong = 0;
  for (qsizetype at = 0; at < good.size(); ++at) {
    for (const int flip : {0x01, 0x20, 0x80}) {
      QByteArray bad = good;
      bad[at] = char(bad[at] ^ flip);
      this->Write(bad);
      const SettingsFile damaged(this->path);
      const bool same =
          damaged.Get("theme").toString() == "dark" && damaged.Get("samples").toInt() == 4;
      const bool none = damaged.Get("theme").isUndefined() && !damaged.Problem().isEmpty();
      wrong += same || none ? 0 : 1; // spaces between the values may become other spaces
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST_F(SettingsFileTest, ADamagedFileIsKeptBesideWhenANewOneIsWritten) {
  ASSERT_TRUE(SettingsFile(this->path).Set("a", 1));
  const QByteArray cut = this->Bytes().left(30);
  this->Write(cut);
  SettingsFile file(this->path);
  EXPECT_FALSE(file.Problem().isEmpty());
  ASSERT_TRUE(file.Set("b", 2));
  QFile kept(this->path + ".damaged");
  ASSERT_TRUE(kept.open(QIODevice::ReadOnly));
  EXPECT_EQ(kept.readAll(), cut);
  const SettingsFile read(this->path);
  EXPECT_TRUE(read.Problem().isEmpty()) << read.Problem().toStdString();
  EXPECT_EQ(read.Get("b").toInt(), 2);
}

TEST_F(SettingsFileTest, StrangeThingsInItsPlaceAreNoFiles) {
  ASSERT_TRUE(SettingsFile(this->path).Set("a", 1));
  ASSERT_TRUE(QFile::remove(this->path));
  ASSERT_EQ(mkfifo(this->path.toUtf8().constData(), 0600), 0); // opening it would never end
  SettingsFile pipe(this->path);
  EXPECT_NE(pipe.Problem().indexOf("not a file"), -1);
  ASSERT_TRUE(pipe.Set("a", 2));
  EXPECT_EQ(SettingsFile(this->path).Get("a").toInt(), 2);
  this->Write(QByteArray(5 << 20, ' '));
  EXPECT_NE(SettingsFile(this->path).Problem().indexOf("bytes; accepted"), -1);
  this->Write(R"({"version": 2, "sha256": "", "settings": {}})");
  EXPECT_NE(SettingsFile(this->path).Problem().indexOf("version 2"), -1);
  // A folder that is a file.
  SettingsFile nowhere(this->path + "/settings.json");
  EXPECT_FALSE(nowhere.Set("a", 1));
  EXPECT_NE(nowhere.Problem().indexOf("not saved"), -1);
  EXPECT_EQ(nowhere.Get("a").toInt(), 1); // in this process
}

TEST_F(SettingsFileTest, AWriteThatDoesNotFitLeavesTheOldFile) {
  SettingsFile file(this->path);
  ASSERT_TRUE(file.Set("a", 1));
  const QByteArray before = this->Bytes();
  const pid_t child = fork(); // files may have 2 KiB: as on a full disk
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2048, 2048};
    setrlimit(RLIMIT_FSIZE, &limit);
    const bool saved = file.Set("a", QString(100000, 'x'));
    _exit(saved ? 1 : file.Problem().contains("not saved") ? 0 : 2);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  EXPECT_EQ(this->Bytes(), before);
}

TEST_F(SettingsFileTest, AProgramThatIsKilledWhileItWritesLeavesAWholeFile) {
  ASSERT_TRUE(SettingsFile(this->path).Set("text", QString(200000, 'a')));
  for (int round = 0; round < 20; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      SettingsFile file(this->path);
      for (int i = 0;; ++i) {
        file.Set("text", QString(200000, QChar('a' + i % 26)));
      }
    }
    usleep(useconds_t(3000 + 1700 * round));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    const SettingsFile read(this->path);
    ASSERT_TRUE(read.Problem().isEmpty()) << read.Problem().toStdString();
    const QString text = read.Get("text").toString();
    ASSERT_EQ(text.size(), 200000);
    ASSERT_EQ(text.count(text[0]), 200000);
  }
  // The lock of the one that was killed is no hindrance, nor is one that was not written to its
  // end.
  SettingsFile file(this->path);
  EXPECT_TRUE(file.Set("a", 1)) << file.Problem().toStdString();
  QFile::remove(this->path + ".lock");
  QFile empty(this->path + ".lock");
  ASSERT_TRUE(empty.open(QIODevice::WriteOnly));
  empty.close();
  EXPECT_TRUE(file.Set("a", 2)) << file.Problem().toStdString();
}

TEST_F(SettingsFileTest, AnotherProgramThatWritesIsWaitedFor) {
  SettingsFile file(this->path);
  ASSERT_TRUE(file.Set("a", 1));
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const int held = open((this->path + ".lock").toLocal8Bit().constData(), O_RDWR);
    const bool locked = held >= 0 && flock(held, LOCK_EX) == 0;
    _exit(write(ready[1], locked ? "y" : "n", 1) == 1 && pause() ? 0 : 1);
  }
  char answer = 0;
  ASSERT_EQ(read(ready[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  EXPECT_FALSE(file.Set("a", 2));
  EXPECT_NE(file.Problem().indexOf("another program holds its lock"), -1);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(file.Set("a", 2)) << file.Problem().toStdString();
  close(ready[0]);
  close(ready[1]);
}
