# tests of tled
byssus_test(unit/tled/test_static base tled)
byssus_test(unit/tled/test_time base tled)
byssus_test(unit/tled/test_critical base tled)
