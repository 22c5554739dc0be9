# tests of proxy
foreach(topic kernel curvature sample)
  byssus_test(unit/proxy/test_${topic} base sph proxy)
endforeach()
