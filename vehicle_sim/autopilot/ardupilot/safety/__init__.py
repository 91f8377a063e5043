"""What watches over an ArduCopter (the checks before arming, the fence, the failsafes), and what it makes it fly."""
