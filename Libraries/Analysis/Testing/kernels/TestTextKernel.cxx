// The text-kernel parser, the pool, leap seconds and meta-kernels.
#include <fstream>

#include <erfa.h>

#include <TemporaryFolder.h>
#include <TestData.h>

#include <dspace/Error.h>
#include <dspace/kernels/KernelPool.h>
#include <dspace/kernels/LeapSecondKernel.h>
#include <dspace/kernels/MetaKernel.h>
#include <dspace/kernels/TextKernel.h>

namespace {

using namespace dspace;

KernelPool PoolOf(const std::string& data, const std::string& name = "k.tpc") {
  KernelPool pool;
  pool.Add(TextKernel::Parse("\\begindata\n" + data + "\n", name));
  return pool;
}

// The message of the error that `data` causes.
std::string Rejected(const std::string& data) {
  try {
    TextKernel::Parse("KPL/PCK\n\\begindata\n" + data, "k.tpc");
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Corrupt) << data;
    return error.what();
  }
  ADD_FAILURE() << "accepted: " << data;
  return {};
}

TEST(TextKernel, ReadsAssignmentsOfAllForms) {
  const TextKernel kernel = TextKernel::Parse("KPL/FK\nA = 1 is a comment\n  \\begindata  \r\n"
                                              "A=1\tB += ( 1.5D3, -2d-1\n +.5 4. )\n"
                                              "\\begintext\nC = 2\n\\begindata\n"
                                              "NAME/x-1 = 'it''s' L = ( 'a' 'b','c', )\n",
                                              "k.tf");
  EXPECT_EQ(kernel.Kind(), "FK");
  ASSERT_EQ(kernel.Assignments().size(), 4u);
  EXPECT_EQ(kernel.Assignments()[0].numbers, std::vector<double>({1.0}));
  const KernelAssignment& b = kernel.Assignments()[1];
  EXPECT_TRUE(b.append);
  EXPECT_EQ(b.numbers, std::vector<double>({1500.0, -0.2, 0.5, 4.0}));
  EXPECT_EQ(b.line, 4);
  EXPECT_EQ(kernel.Assignments()[2].name, "NAME/x-1");
  EXPECT_EQ(kernel.Assignments()[2].texts, std::vector<std::string>({"it's"}));
  EXPECT_EQ(kernel.Assignments()[3].texts, std::vector<std::string>({"a", "b", "c"}));
}

TEST(TextKernel, ReadsDatesAsSecondsPastJ2000) {
  const KernelPool pool =
      PoolOf("D = ( @2000-JAN-1 @2000-JAN-1-12:00 @1972-JAN-1, @2016-05-10/23:26:03.40 "
             "@2000-01-01T12:00:00.5 @2000-366 @2000-FEBRUARY-29 )");
  const std::vector<double>& d = pool.Numbers("D", 7);
  EXPECT_EQ(d[0], -43200.0);
  EXPECT_EQ(d[1], 0.0);
  double mjd0 = 0.0, mjd = 0.0;
  eraCal2jd(1972, 1, 1, &mjd0, &mjd);
  EXPECT_EQ(d[2], (mjd - 51544.5) * 86400.0);
  eraCal2jd(2016, 5, 10, &mjd0, &mjd);
  EXPECT_NEAR(d[3], (mjd - 51544.5) * 86400.0 + 84363.4, 1e-6);
  EXPECT_EQ(d[4], 0.5);
  EXPECT_EQ(d[5], 365 * 86400.0 - 43200.0);
  EXPECT_EQ(d[6], 59 * 86400.0 - 43200.0);
  for (const char* bad :
       {"@", "@2000", "@2000-13-1", "@2001-FEB-29", "@2000-JAN-32", "@2000-JAN-1-25:00",
        "@2000-JAN-1-12:61", "@2000-XYZ-1", "@2001-366", "@2000-JAN-1-12.5:00"}) {
    EXPECT_NE(Rejected(std::string("D = ") + bad).find("line 3"), std::string::npos) << bad;
  }
}

TEST(TextKernel, ErrorsNameFileLineAndWhatIsAccepted) {
  const std::pair<const char*, const char*> cases[] = {
      {"A = 1\nB", "line 4: variable B has no value"},
      {"A 1", "variable A is followed by '1'; accepted: = or +="},
      {"A = ( 1 2", "has no ')'"},
      {"A = ( )", "its list is empty"},
      {"A = ( 1,, 2 )", "a comma without a value"},
      {"A = ( , 1 )", "a comma without a value"},
      {"A = ( 1 'x' )", "mixes texts and numbers"},
      {"A = 'x", "no closing quote"},
      {"A = 1e999", "accepted: a finite number"},
      {"A = nan", "accepted: a finite number"},
      {"A = 0x10", "accepted: a finite number"},
      {"A = 1.2.3", "accepted: a finite number"},
      {"A = x", "accepted: a finite number"},
      {"A = ( ( 1 ) )", "accepted: a finite number"},
      {"( 1 ) = 2", "is no assignment"},
      {"= 2", "accepted: 1 to 32"},
      {"A234567890123456789012345678901234 = 2", "accepted: 1 to 32"},
      {"A = 1 \x01", "the byte 1"},
      {"A = 1 \xc3\xa4", "the byte 195"},
  };
  for (const auto& [data, message] : cases) {
    const std::string what = Rejected(data);
    EXPECT_NE(what.find(message), std::string::npos) << data << "\n" << what;
    EXPECT_NE(what.find("text kernel 'k.tpc': line "), std::string::npos) << what;
  }
  EXPECT_THROW(TextKernel::Parse("KPL/PCK\nA = 1\n", "k"), Error); // no data
  EXPECT_THROW(TextKernel::Read("/nonexistent.tpc"), Error);
}

TEST(KernelPool, AppendsReplacesAndNamesTheWinner) {
  KernelPool pool;
  pool.Add(TextKernel::Parse("\\begindata\nA = 1 B = 'x' C = 3", "first.tpc"));
  pool.Add(TextKernel::Parse("\\begindata\nA = ( 2 3 ) B += 'y' C = 3", "second.tpc"));
  EXPECT_EQ(pool.Numbers("A"), std::vector<double>({2.0, 3.0}));
  EXPECT_EQ(pool.Texts("B"), std::vector<std::string>({"x", "y"}));
  EXPECT_EQ(pool.Find("A")->file, "second.tpc");
  ASSERT_EQ(pool.Conflicts().size(), 1u); // C has the same value in both
  EXPECT_EQ(pool.Conflicts()[0].name, "A");
  EXPECT_EQ(pool.Conflicts()[0].winner, "second.tpc");
  EXPECT_EQ(pool.Conflicts()[0].loser, "first.tpc");
  EXPECT_THROW(pool.Number("A"), Error);
  EXPECT_THROW(pool.Numbers("B"), Error);
  EXPECT_THROW(pool.Number("NONE"), Error);
  // A rejected kernel changes nothing.
  EXPECT_THROW(pool.Add(TextKernel::Parse("\\begindata\nC = 4 A += 'z'", "third.tpc")), Error);
  EXPECT_EQ(pool.Number("C"), 3.0);
}

TEST(KernelPool, NearMatches) {
  EXPECT_EQ(NearMatches("IAU_MONO", {"J2000", "IAU_MOON", "IAU_MARS"}), "'IAU_MOON'");
  EXPECT_EQ(NearMatches("zzzzzz", {"J2000"}), "");
}

TEST(LeapSecondKernel, EqualsErfasTable) {
  DSPACE_REAL_DATA(path, "ephemeris/naif0012.tls");
  KernelPool pool;
  pool.Add(TextKernel::Read(path));
  ASSERT_TRUE(HasLeapSeconds(pool));
  const TimeScales scales = TimeScalesOf(pool);
  int count = 0;
  for (int year = 1972; year <= 2017; ++year) {
    for (const int month : {1, 7}) {
      double mjd0 = 0.0, mjd = 0.0, dat = 0.0;
      eraCal2jd(year, month, 1, &mjd0, &mjd);
      ASSERT_EQ(eraDat(year, month, 1, 0.0, &dat), 0);
      EXPECT_EQ(scales.GetLeapSeconds().TaiMinusUtc(int(mjd)), dat) << year << " " << month;
      ++count;
    }
  }
  EXPECT_EQ(count, 92);
  EXPECT_THROW(TimeScalesOf(PoolOf("DELTET/DELTA_AT = ( 10 @1972-JAN-1 11 )")), Error);
  EXPECT_THROW(TimeScalesOf(PoolOf("DELTET/DELTA_AT = ( 10 @1972-JAN-1-12:00 )")), Error);
  EXPECT_THROW(TimeScalesOf(PoolOf("DELTET/DELTA_AT = ( 10 @1972-JAN-1 )")), Error); // no DELTET/K
}

TEST(MetaKernel, ResolvesSymbolsContinuationsAndFolders) {
  const dspace::testing::TemporaryFolder folder;
  const std::string here = std::string(folder.Path());
  std::ofstream(here + "/beside.tls") << "x";
  std::ofstream(here + "/all.tm") << "KPL/MK\n\\begindata\n"
                                     "PATH_VALUES = ( '/data/kernels' )\n"
                                     "PATH_SYMBOLS = ( 'K' )\n"
                                     "KERNELS_TO_LOAD = ( '$K/a.bsp' 'beside.tls' '/x/long+'\n"
                                     "                    'name.tpc' 'elsewhere.tf' )\n";
  const TextKernel kernel = TextKernel::Read(here + "/all.tm");
  EXPECT_TRUE(IsMetaKernel(kernel));
  EXPECT_EQ(KernelsToLoad(kernel),
            std::vector<std::string>(
                {"/data/kernels/a.bsp", here + "/beside.tls", "/x/longname.tpc", "elsewhere.tf"}));
  for (const char* bad :
       {"KERNELS_TO_LOAD = '$K/a.bsp'", "KERNELS_TO_LOAD = 'a+'", "KERNELS_TO_LOAD = 3",
        "KERNELS_TO_LOAD = 'a' PATH_SYMBOLS = ( 'A' 'B' ) PATH_VALUES = 'x'"}) {
    EXPECT_THROW(KernelsToLoad(TextKernel::Parse(std::string("\\begindata\n") + bad, "m.tm")),
                 Error)
        << bad;
  }
  EXPECT_FALSE(IsMetaKernel(TextKernel::Parse("\\begindata\nA = 1", "k")));
}

TEST(TextKernel, ReadsEveryRealKernel) {
  DSPACE_REAL_DATA(folder, "ephemeris");
  KernelPool pool;
  for (const char* name :
       {"naif0011.tls", "naif0012.tls", "pck00011.tpc", "gm_de440.tpc", "moon_080317.tf",
        "spice_test_kernels/cas00167.tsc", "spice_test_kernels/cas_v40.tf",
        "spice_test_kernels/cas_iss_v10.ti", "spice_test_kernels/earth_topo_050714.tf",
        "spice_test_kernels/pck00010.tpc"}) {
    EXPECT_TRUE(TextKernel::Recognizes(folder + "/" + name)) << name;
    pool.Add(TextKernel::Read(folder + "/" + name));
  }
  EXPECT_FALSE(TextKernel::Recognizes(folder + "/moon_pa_de421_1900-2050.bpc"));
  // As the files print them.
  EXPECT_EQ(pool.Number("DELTET/K"), 1.657e-3);
  EXPECT_EQ(pool.Numbers("BODY301_PM"), std::vector<double>({38.3213, 13.17635815, -1.4e-12}));
  EXPECT_EQ(pool.Numbers("TKFRAME_31007_ANGLES"), std::vector<double>({67.92, 78.56, 0.30}));
  EXPECT_EQ(pool.Texts("NAIF_BODY_NAME").size(), pool.Numbers("NAIF_BODY_CODE").size());
  EXPECT_EQ(pool.Numbers("SCLK01_COEFFICIENTS_82").size() % 3, 0u);
}

} // namespace
